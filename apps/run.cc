// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/live/live_source.h"
#include "plumbline/io/live/open_live_source.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/map_file/map_view_angle.h"
#include "plumbline/io/recordings/mcap_file_writer.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/slam/options_without_effect.h"
#include "plumbline/slam/preset.h"
#include "plumbline/slam/system.h"
#include "plumbline/version.h"
#include "plumbline/viewer/viewer.h"

#include "apps/command_inputs.h"
#include "apps/command_line.h"
#include "apps/command_outputs.h"
#include "apps/commands.h"
#include "apps/inertial_input.h"
#include "apps/program_methods.h"
#include "apps/run_frames.h"
#include "apps/run_results.h"
#include "apps/stop_signal.h"
#include "apps/view_options.h"
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kLookStep = std::chrono::milliseconds(20);
constexpr int kLongestPause = 1'000'000;  // seconds
constexpr int kWidestBlur = 1001;         // pixels; nothing is left to see by then

CommandSyntax RunSyntax() {
  return {
      "run",
      "Tracks the camera through a recorded sequence, or while it runs, and maps what it sees.\n"
      "PATH: a data set; camera:N or camera:N,M; rtsp://...; gst:PIPELINE; - (standard input)",
      {"PATH"},
      {{"--sensor", "mono|stereo|rgbd", "default: the richest the data offers"},
       {"--format",
        "auto|euroc|tum|kitti|images|video|bag|mcap|rosbag2",
        "default: found out from PATH"},
       {"--topic", "NAME", "images of a bag or an MCAP file; may be repeated (left, right, depth)"},
       {"--side-by-side", "", "live: each image is a left and a right half"},
       {"--camera", "FILE", "camera file, or the name of a built-in camera"},
       {"--preset", "NAME", "the system of a paper: rippl, good-line-cutting"},
       {"--imu",
        "FILE|off|auto",
        "gyroscope calibration; auto: with the data (default: auto, off with --preset)"},
       {"--ground-truth", "FILE|none", "poses to compare with (default: those with the data)"},
       {"--rotate", "auto|none|90|180|270", kRotateHelp},
       {"--max-width", "PIXELS", kMaxWidthHelp},
       {"--view-angle", "DEGREES", kViewAngleHelp},
       {"--mask",
        "FILE|TOPIC",
        "image that is black where nothing is to be used; may be repeated (left, right)"},
       {"--config", "FILE", "options from a YAML file; may be repeated"},
       {"--set", "KEY=VALUE", "one option; may be repeated"},
       {"--from", "N", "first frame (default 0)"},
       {"--to", "N", "end before this frame (default: the end)"},
       {"--stride", "N", "every N-th frame (default 1)"},
       {"--blur", "N", "N x N box filter on every input image (even N: shifted by half a pixel)"},
       {"--mode", "inline|lockstep|live", "how the stages run; wins over --set slam.mode"},
       {"--seed", "N", "of everything random; wins over --set slam.seed"},
       {"--map", "FILE", "go on in the map of an earlier run (its map.plb)"},
       {"--localize", "", "only find the camera in --map, and change nothing of it"},
       {"--save-every", "SECONDS", "save the map so often while running"},
       {"--out", "DIR", "folder for the results (default: plumbline_run)"},
       {"--view", "[HOST:]PORT", "show it in browsers, and in Foxglove"},
       {"--stay", "", "with --view: show the finished run until Ctrl-C"},
       {"--view-origin", "URL", "another page that may connect to --view; may be repeated"},
       {"--record", "FILE.mcap", "write what viewers are sent into a file"},
       {"--quiet", "", "print nothing but errors"}},
      {{"--checkpoint", "--save-every SECONDS saves the map of a run that may be stopped"},
       {"--resume", "--map FILE goes on in the map of an earlier run"},
       {"--reverse", "a data set that lists its images in the other order does the same"}}};
}

FrameSelection ReadRange(const CommandLine& line) {
  FrameSelection range;
  range.from = static_cast<std::size_t>(line.Count("--from", 0, {0, kMostFrames}));
  range.stride = static_cast<std::size_t>(line.Count("--stride", 1, {1, kMostFrames}));
  range.to = static_cast<std::size_t>(line.Count("--to", kMostFrames, {1, kMostFrames}));
  return range;
}

// 0 without a filter.
int ReadBlur(const CommandLine& line) { return line.Count("--blur", 0, {1, kWidestBlur}); }

// The frames to process, by index in the data set.
std::vector<std::size_t> ChooseFrames(const CommandLine& line, const Dataset& dataset) {
  const auto [from, last, stride] = ReadRange(line);
  const std::size_t to = std::min(dataset.size(), last);
  if (from >= to) {
    throw InputError(fmt::format(
        "--from {}: the sequence has {} frames, and --to is {}", from, dataset.size(), to));
  }
  std::vector<std::size_t> frames;
  for (std::size_t i = from; i < to; i += stride) frames.push_back(i);
  return frames;
}

struct RunSetup {
  SlamOptions options;
  std::string options_yaml;
  std::vector<std::string> set;  // keys of the options that the user has set
  std::filesystem::path folder;
  int blur = 0;
  bool quiet = false;
  std::optional<std::filesystem::path> map;  // to go on in
  bool localize = false;
  int save_every_s = 0;  // 0: at the end only
  ViewerOptions view;    // where the run is to be shown
};

// A camera does not wait. Standard input does: nothing is lost if its frames are processed one
// after the other.
bool IsLiveByDefault(const std::string& name) {
  const auto kind = LiveKindOf(name);
  return kind && *kind != LiveKind::kStandardInput;
}

RunSetup ReadSetup(const CommandLine& line) {
  RunSetup setup;
  if (IsLiveByDefault(line.Positional(0))) setup.options.slam.mode = RunMode::kLive;
  OptionTable table(setup.options, ProgramMethods().added);
  if (const auto preset = line.Value("--preset")) LoadPreset(*preset, table);
  const SlamOptions unset = setup.options;
  for (const std::string& file : line.Values("--config")) table.LoadFile(file);
  setup.set = DifferentOptions(unset, setup.options);  // a file may list all options
  for (const std::string& assignment : line.Values("--set")) {
    table.Set(assignment);
    setup.set.push_back(assignment.substr(0, assignment.find('=')));
  }
  if (const auto mode = line.Value("--mode")) table.Set("slam.mode=" + *mode);
  if (const auto seed = line.Value("--seed")) table.Set("slam.seed=" + *seed);
  CheckOptions(setup.options, ProgramMethods());
  setup.options_yaml = table.Dump();
  setup.folder = line.Value("--out").value_or("plumbline_run");
  if (setup.folder == "-") throw InputError("--out: expected a folder, found -");
  setup.blur = ReadBlur(line);
  setup.quiet = line.Has("--quiet");
  setup.view.access = ReadViewOptions(line, setup.quiet);
  if (line.Has("--stay") && !setup.view.access) {
    throw InputError("--stay: expected --view [HOST:]PORT as well");
  }
  if (const auto record = line.Value("--record")) setup.view.record = *record;
  setup.view.record_all = setup.options.slam.mode != RunMode::kLive;
  if (const auto map = line.Value("--map")) setup.map = *map;
  setup.localize = line.Has("--localize");
  if (setup.localize && !setup.map) throw InputError("--localize: expected --map FILE as well");
  setup.save_every_s = line.Count("--save-every", 0, {1, kLongestPause});
  if (setup.localize && setup.save_every_s > 0) {
    throw InputError("--save-every: expected a map that changes, found --localize");
  }
  return setup;
}

// The sensor that is asked for: by --sensor, or by the preset, which is made for one.
std::optional<SensorKind> ReadSensor(const CommandLine& line) {
  std::optional<SensorKind> sensor;
  if (const auto name = line.Value("--sensor")) sensor = ParseChoice<SensorKind>("--sensor", *name);
  const auto preset = line.Value("--preset");
  if (!preset) return sensor;
  const SensorKind needed =
      FindPreset(*preset).needs_stereo ? SensorKind::kStereo : SensorKind::kMono;
  if (sensor && *sensor != needed) {
    throw InputError(fmt::format(
        "--preset {}: expected --sensor {}, found {}", *preset, NameOf(needed), NameOf(*sensor)));
  }
  return needed;
}

DatasetOptions ReadDatasetOptions(const CommandLine& line) {
  DatasetOptions options;
  options.sensor = ReadSensor(line);
  const auto format = line.Value("--format");
  if (format && *format != "auto") options.format = ParseChoice<DatasetFormat>("--format", *format);
  options.camera = line.Value("--camera");
  options.ground_truth = line.Value("--ground-truth");
  options.topics = line.Values("--topic");
  options.rotate = ReadRotation(line);
  options.max_width = ReadMaxWidth(line);
  options.view_angle_deg = ReadViewAngle(line);
  options.masks = line.Values("--mask");
  return options;
}

RunFrames OpenLive(const CommandLine& line, const RunSetup& setup) {
  for (const char* option : {"--format", "--topic", "--ground-truth"}) {
    if (line.Has(option)) {
      throw InputError(std::string(option) + ": expected a recording, found a live source");
    }
  }
  RunFrames input;
  input.blur = setup.blur;
  input.save_every_s = setup.save_every_s;
  input.range = ReadRange(line);
  if (input.range.from >= input.range.to) {
    throw InputError(fmt::format("--from {}: --to is {}", input.range.from, input.range.to));
  }
  LiveOptions options;
  options.sensor = ReadDatasetOptions(line).sensor;
  options.camera = line.Value("--camera");
  options.side_by_side = line.Has("--side-by-side");
  options.rotate = ReadRotation(line);
  options.max_width = ReadMaxWidth(line);
  options.view_angle_deg = ReadViewAngle(line);
  options.masks = line.Values("--mask");
  input.live = OpenLiveSource(line.Positional(0), options);
  input.dataset = std::make_shared<PassedFrames>(input.live->info());
  return input;
}

// Reports a note of a run beside its results, in one line.
void Say(const std::string& note) {
  std::clog << "plumbline: " << Printable(note, kLongestMessage) << '\n';
}

// Opens a recording, for a map that it goes on in with the view angle of the map. If it lacks the
// sensor of the preset, the message names the preset.
std::unique_ptr<Dataset> OpenRecorded(const CommandLine& line, const SavedAtlas* map) {
  try {
    DatasetOptions options = ReadDatasetOptions(line);
    auto dataset = OpenDataset(line.Positional(0), options);
    if (map == nullptr) return dataset;
    if (const auto difference = ViewAngleDifference(map->context.camera, dataset->calibration())) {
      throw InputError(line.Value("--map").value() +
                       ": expected a map of the same rectified camera, found " + *difference);
    }
    if (options.view_angle_deg) return dataset;
    options.view_angle_deg = ViewAngleOfMap(map->context.camera, dataset->calibration());
    if (!options.view_angle_deg) return dataset;
    Say(fmt::format("the images are cut out as for the map: --view-angle {:g}",
                    *options.view_angle_deg));
    return OpenDataset(line.Positional(0), options);
  } catch (const MissingSensor& error) {
    const auto preset = line.Value("--preset");
    if (!preset || line.Has("--sensor")) throw;
    throw InputError(fmt::format("--preset {}: {}", *preset, error.what()));
  }
}

// Reports the data that the preset does not use.
void SayUnused(const CommandLine& line, const Dataset& dataset) {
  const auto preset = line.Value("--preset");
  if (!preset || line.Has("--sensor") || FindPreset(*preset).needs_stereo) return;
  for (const SensorKind sensor : dataset.info().available) {
    if (sensor == SensorKind::kMono) continue;
    Say(fmt::format("--preset {} is for one camera: {} is not used",
                    *preset,
                    sensor == SensorKind::kStereo ? "the right image" : "depth"));
  }
}

// Reports options that the user has set and others leave without effect.
void SayWithoutEffect(const RunSetup& setup, const Dataset& dataset) {
  const bool has_map = setup.map.has_value();
  for (const std::string& note :
       OptionsWithoutEffect(setup.options, setup.set, NameOf(dataset.sensor()), has_map)) {
    Say(note);
  }
}

RunFrames OpenInput(const CommandLine& line, const RunSetup& setup, const SavedAtlas* map) {
  if (LiveKindOf(line.Positional(0))) return OpenLive(line, setup);
  if (line.Has("--side-by-side")) {
    throw InputError("--side-by-side: expected a live source, found " +
                     InQuotes(line.Positional(0)));
  }
  RunFrames input;
  input.blur = setup.blur;
  input.save_every_s = setup.save_every_s;
  auto dataset = OpenRecorded(line, map);
  input.frames = ChooseFrames(line, *dataset);
  input.dataset = std::move(dataset);
  return input;
}

// Input files of the run.
std::vector<RunInput> InputsOf(const CommandLine& line, const Dataset& dataset) {
  std::vector<RunInput> inputs = CommandInputs(line, dataset);
  if (const auto map = line.Value("--map")) inputs.push_back({*map, true});
  return inputs;
}

// The map that the run continues: who made it, and remarks for the user.
struct LoadedMap {
  std::size_t sessions = 0;        // that made it
  std::vector<std::string> notes;  // System::Continue
};

// Gives the map that is to be gone on in, which was read whole before anything is written, to the
// system.
LoadedMap MoveMapInto(System& system, const RunSetup& setup, std::optional<SavedAtlas> saved) {
  if (!saved) return {};
  const std::size_t sessions = saved->context.sessions.size();
  try {
    return {sessions, system.Continue(*std::move(saved), setup.localize)};
  } catch (const InputError& error) {
    throw InputError(setup.map->string() + ": " + error.what());
  }
}

// The recording takes the place of a file when it is complete.
void CheckRecording(const std::filesystem::path& file,
                    const std::filesystem::path& out,
                    std::span<const RunInput> inputs) {
  CheckFileApart("--record", file, inputs);
  CheckFileApart("--record", McapFileWriter::PartOf(file), inputs);
  CheckNoResult("--record", file, out);
  CheckReplaceable(file);
  const std::string beginning = McapFileWriter::Beginning();
  CheckReplacesItsKind("--record", file, {"a recording by plumbline", beginning});
}

// Before anything is done: that there is somewhere to listen, and to record to.
void OpenViewer(const CommandLine& line,
                const RunSetup& setup,
                const RectifiedCamera& camera,
                const LoadedMap& loaded,
                RunFrames& input) {
  if (!setup.view.access && !setup.view.record) return;
  if (setup.view.record) {
    if (const auto note = McapFileWriter::SetPartAside(*setup.view.record)) Say(*note);
  }
  ViewedRun run;
  run.name = input.dataset->info().name.empty() ? WithoutPassword(line.Positional(0))
                                                : input.dataset->info().name;
  run.camera = camera;
  run.can_pause = input.live == nullptr;
  if (run.can_pause) run.frames_expected = input.frames.size();
  input.viewer = std::make_shared<Viewer>(
      setup.view, std::move(run), SessionId{static_cast<std::int64_t>(loaded.sessions)});
  if (setup.view.access && !setup.quiet) {
    std::clog << "plumbline: view at " << input.viewer->url() << '\n';
  }
}

// The options first: if they cannot be written, nothing can.
void WriteOptions(const RunSetup& setup, RunFolder& folder) {
  folder.Write({"options.yaml", [&](const std::filesystem::path& path) {
                  WriteFileAtomically(path, setup.options_yaml);
                }});
  if (const auto failure = folder.Failures()) throw InputError(*failure);
}

void SayBefore(const Dataset& dataset,
               const RunFolder& folder,
               const std::vector<std::string>& map_notes,
               bool quiet) {
  for (const std::string& note : folder.notes()) Say(note);
  if (quiet) return;
  for (const std::string& note : map_notes) Say(note);
  for (const std::string& note : dataset.info().notes) Say(note);
  if (const auto& fault = dataset.info().ground_truth_fault) Say("no errors: " + *fault);
}

// Records the frames of a live source, known at its end.
void NoteFrames(const FrameLog& frames, RunFrames& input) {
  DatasetInfo info = input.live->info();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    info.stamps_ns.push_back(frames.StampOf(i));
    input.frames.push_back(i);
  }
  input.dataset = std::make_shared<PassedFrames>(std::move(info));
}

std::vector<std::string> ToBeShown(std::span<const std::string> arguments) {
  std::vector<std::string> shown;
  for (const std::string& argument : arguments) shown.push_back(WithoutPassword(argument));
  return shown;
}

// Prints the result, for whoever still listens.
void Print(const RunResult& result, const Dataset& dataset, const std::filesystem::path& folder) {
  errno = 0;
  PrintResult(result, dataset, folder.string());
  if (!std::cout.flush() && errno == EPIPE) std::cout.clear();
}

// Shows the finished run until a signal comes, and answers requests about its maps. Returns at once
// if a signal has ended the run.
void KeepShowing(const CommandLine& line, const RunResult& result, Viewer& viewer, bool quiet) {
  if (!line.Has("--stay") || FirstStopSignal()) return;
  if (!quiet) std::clog << "plumbline: the view stays at " << viewer.url() << " (Ctrl-C ends it)\n";
  while (!StopRequested() && !viewer.TakeFailure()) {
    if (viewer.WantsMaps(false)) viewer.ReadMaps(result.atlas, result.events);
    std::this_thread::sleep_for(kLookStep);
  }
}

// In one line, whatever went wrong.
void RethrowFailures(const Processed& processed, const std::optional<std::string>& not_written) {
  std::string failures = not_written.value_or("");
  if (processed.not_recorded) {
    failures += (failures.empty() ? "" : "; ") + *processed.not_recorded;
  }
  try {
    if (processed.failure) std::rethrow_exception(processed.failure);
  } catch (const InputError& error) {
    throw InputError(error.what() + (failures.empty() ? "" : "; " + failures));
  }
  if (!failures.empty()) throw InputError(failures);
}

// Gives the inertial sensor that --imu asks for to the frames and the system.
InertialInput UseInertial(const CommandLine& line, RunFrames& input, System& system) {
  const InertialRequest request = ReadInertialRequest(line);
  InertialInput inertial =
      input.live ? OpenLiveInertial(request, *input.live) : OpenInertial(request, *input.dataset);
  input.inertial = inertial.recording;
  if (input.inertial) system.UseInertial(input.inertial->calibration);
  return inertial;
}

RunDescription DescribeRun(const CommandLine& line,
                           std::span<const std::string> arguments,
                           const RunSetup& setup,
                           const RunFrames& input) {
  RunDescription description{PLUMBLINE_VERSION,
                             WithoutPassword(line.Positional(0)),
                             setup.options_yaml,
                             setup.options.slam.seed,
                             ToBeShown(arguments)};
  description.frames_chosen = input.frames.size();
  description.preset = line.Value("--preset");
  return description;
}

}  // namespace

int RunCommand(std::span<const std::string> arguments) {
  const CommandLine line(RunSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(RunSyntax());
    return 0;
  }
  const auto start = Clock::now();
  RunSetup setup = ReadSetup(line);
  std::optional<SavedAtlas> map;
  if (setup.map) map = LoadAtlas(*setup.map);
  RunFrames input = OpenInput(line, setup, map ? &*map : nullptr);
  const std::vector<RunInput> inputs = InputsOf(line, *input.dataset);
  CheckApart(setup.folder, inputs);
  if (setup.view.record) CheckRecording(*setup.view.record, setup.folder, inputs);
  System system(input.dataset->calibration(), setup.options, {}, ProgramMethods());
  const InertialInput inertial = UseInertial(line, input, system);
  const LoadedMap loaded = MoveMapInto(system, setup, std::move(map));
  RunFolder folder(setup.folder);
  OpenViewer(line, setup, system.rectifier().camera(), loaded, input);
  WriteOptions(setup, folder);
  IgnoreBrokenPipes();
  if (!setup.quiet) SayUnused(line, *input.dataset);
  if (!setup.quiet) SayWithoutEffect(setup, *input.dataset);
  SayBefore(*input.dataset, folder, loaded.notes, setup.quiet);
  if (!setup.quiet) {
    for (const std::string& note : inertial.notes) Say(note);
  }
  CatchStopSignals();
  KeptViews views(input);
  const Processed processed = ProcessFrames(input, setup.quiet, system, folder, views);
  const RunResult& result = processed.result;
  if (result.frames.empty() && FirstStopSignal()) {
    std::clog << "plumbline: stopped before the first frame; nothing is written\n";
    return FirstStopSignal()->exit_code;
  }
  if (input.live != nullptr) NoteFrames(result.frames, input);
  const Dataset& dataset = *input.dataset;
  RunDescription description = DescribeRun(line, arguments, setup, input);
  description.notes = inertial.notes;
  description.notes.insert(description.notes.end(), processed.notes.begin(), processed.notes.end());
  const bool live = input.live != nullptr;
  const WrittenResults written = WriteResults(
      {result, dataset, views, std::move(description), processed.first_pose_seconds, start, live},
      folder);
  if (!setup.quiet) {
    Print(result, dataset, written.earlier_kept ? folder.part() : folder.path());
  }
  if (written.earlier_kept) Say(NoteOfEarlierKept(folder));
  if (input.viewer) KeepShowing(line, result, *input.viewer, setup.quiet);
  RethrowFailures(processed, written.failure);
  if (written.interrupted) return written.interrupted->exit_code;
  const auto no_pose = WhyNoPose(result.frames, processed.no_depth);
  if (no_pose) Say(*no_pose);
  return no_pose ? 1 : 0;
}

}  // namespace plumbline
