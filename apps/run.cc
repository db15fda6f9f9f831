// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/options_io.h"
#include "plumbline/base/printable.h"
#include "plumbline/image/box_filter.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/dataset.h"
#include "plumbline/io/reversed_dataset.h"
#include "plumbline/report/html_report.h"
#include "plumbline/report/overlay.h"
#include "plumbline/report/run_files.h"
#include "plumbline/report/summary.h"
#include "plumbline/slam/pipeline.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/progress.h"
#include "apps/stop_signal.h"
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWidestBlur = 1001;  // pixels; nothing is left to see by then

CommandSyntax Syntax() {
  return {"run",
          "Tracks the camera through a recorded sequence and maps what it sees.",
          {"PATH"},
          {{"--sensor", "mono|stereo|rgbd", "default: the richest the data offers"},
           {"--format", "auto|euroc|tum|kitti|images|video", "default: found out from PATH"},
           {"--camera", "FILE", "camera file, or the name of a built-in camera"},
           {"--config", "FILE", "options from a YAML file; may be repeated"},
           {"--set", "KEY=VALUE", "one option; may be repeated"},
           {"--from", "N", "first frame (default 0)"},
           {"--to", "N", "end before this frame (default: the end)"},
           {"--stride", "N", "every N-th frame (default 1)"},
           {"--reverse", "", "play these frames from the last to the first"},
           {"--blur", "N", "N x N box filter on every input image"},
           {"--mode", "inline|lockstep|live", "how the stages run; same as --set slam.mode"},
           {"--seed", "N", "of everything random; same as --set slam.seed"},
           {"--out", "DIR", "folder for the results (default: plumbline_run)"},
           {"--quiet", "", "print nothing but errors"}}};
}

// The frames to process, by index in the data set.
std::vector<std::size_t> ChooseFrames(const CommandLine& line, const Dataset& dataset) {
  const auto from = static_cast<std::size_t>(line.Count("--from", 0, {0, kMostFrames}));
  const auto stride = static_cast<std::size_t>(line.Count("--stride", 1, {1, kMostFrames}));
  const auto to = std::min(
      dataset.size(), static_cast<std::size_t>(line.Count("--to", kMostFrames, {1, kMostFrames})));
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
  std::filesystem::path folder;
  int blur = 0;
  bool quiet = false;
};

RunSetup ReadSetup(const CommandLine& line) {
  RunSetup setup;
  OptionTable table(setup.options);
  for (const std::string& file : line.Values("--config")) table.LoadFile(file);
  for (const std::string& assignment : line.Values("--set")) table.Set(assignment);
  if (const auto mode = line.Value("--mode")) table.Set("slam.mode=" + *mode);
  if (const auto seed = line.Value("--seed")) table.Set("slam.seed=" + *seed);
  CheckOptions(setup.options);
  setup.options_yaml = table.Dump();
  setup.folder = line.Value("--out").value_or("plumbline_run");
  setup.blur = line.Count("--blur", 0, {1, kWidestBlur});
  setup.quiet = line.Has("--quiet");
  return setup;
}

DatasetOptions ReadDatasetOptions(const CommandLine& line) {
  DatasetOptions options;
  if (const auto sensor = line.Value("--sensor")) {
    options.sensor = ParseChoice<SensorKind>("--sensor", *sensor);
  }
  const auto format = line.Value("--format");
  if (format && *format != "auto") options.format = ParseChoice<DatasetFormat>("--format", *format);
  options.camera = line.Value("--camera");
  return options;
}

// What is fed, by index in the data set.
struct Input {
  std::unique_ptr<Dataset> dataset;
  std::vector<std::size_t> frames;
};

Input OpenInput(const CommandLine& line) {
  Input input;
  input.dataset = OpenDataset(line.Positional(0), ReadDatasetOptions(line));
  input.frames = ChooseFrames(line, *input.dataset);
  if (!line.Has("--reverse")) return input;
  input.dataset = PlayedBackwards(std::move(input.dataset), std::move(input.frames));
  input.frames.resize(input.dataset->size());
  std::iota(input.frames.begin(), input.frames.end(), std::size_t{0});
  return input;
}

// Every image of the frame through the box filter of --blur (0: as it is). Depth stays.
SensorFrame Blurred(SensorFrame frame, int size) {
  if (size <= 1) return frame;
  frame.left = BoxFiltered(frame.left, size);
  if (frame.right) frame.right = BoxFiltered(*frame.right, size);
  return frame;
}

// Frames that are shown with their features, kept until there is time to draw them.
class KeptViews {
 public:
  explicit KeptViews(const std::vector<std::size_t>& frames) {
    for (std::size_t k = 0; k < kOverlays; ++k) {
      const std::size_t position = k * (frames.size() - 1) / (kOverlays - 1);
      wanted_[position] = frames[position];
    }
  }

  void Offer(std::size_t position, const FrameView& view) {
    const auto it = wanted_.find(position);
    if (it != wanted_.end() && !view.images.left.empty()) views_.emplace_back(it->second, view);
  }

  // Writes the overlays; returns the same images for the report.
  std::vector<SampleImage> Write(const std::filesystem::path& folder) const {
    std::vector<SampleImage> samples;
    for (const auto& [frame, view] : views_) {
      const std::string name = fmt::format("overlay_{:06}.png", frame);
      WriteFeatureOverlay(view, folder / name);
      samples.push_back(MakeSampleImage(view, name));
    }
    return samples;
  }

 private:
  static constexpr std::size_t kOverlays = 6;
  std::map<std::size_t, std::size_t> wanted_;  // position in the run -> index in the data set
  std::vector<std::pair<std::size_t, FrameView>> views_;
};

// Waits until a frame is due that was taken `since_first_ns` after the first one. Live only: other
// modes go as fast as they can.
class Player {
 public:
  explicit Player(RunMode mode) : live_(mode == RunMode::kLive) {}

  void WaitFor(std::int64_t since_first_ns) {
    if (!live_) return;
    if (since_first_ns == 0) start_ = Clock::now();
    std::this_thread::sleep_until(start_ + std::chrono::nanoseconds(since_first_ns));
  }

 private:
  bool live_;
  Clock::time_point start_;
};

// Reads the frames and feeds them, until there are no more or somebody asks to stop.
void FeedFrames(const Dataset& dataset,
                const std::vector<std::size_t>& frames,
                const RunSetup& setup,
                const Progress& progress,
                Pipeline& pipeline) {
  Player player(setup.options.slam.mode);
  for (std::size_t k = 0; k < frames.size() && !StopRequested(); ++k) {
    auto frame = dataset.Read(frames[k]);
    const std::int64_t stamp_ns = dataset.stamp_ns(frames[k]);
    player.WaitFor(stamp_ns - dataset.stamp_ns(frames[0]));
    if (frame) {
      pipeline.Feed(Blurred(*frame, setup.blur));
      continue;
    }
    progress.Say(fmt::format(
        "frame {} skipped: {}: {}", frames[k], frame.error().path.string(), frame.error().why));
    pipeline.Skip(stamp_ns, "image_unreadable");
  }
}

struct Progressed {
  std::optional<double> first_pose_seconds;  // from the start of the process
  std::optional<InputError> failure;         // why not all frames were taken
};

// Bad input in the middle, such as an image of another size, ends a run; what was done until then
// is kept. Throws when that is nothing.
Progressed ProcessFrames(const Dataset& dataset,
                         const std::vector<std::size_t>& frames,
                         const RunSetup& setup,
                         System& system,
                         KeptViews& views) {
  Progressed result;
  Progress progress(frames.size(), setup.quiet);
  Pipeline pipeline(system, [&](const FrameRecord& record, const FrameView& view) {
    const auto position = static_cast<std::size_t>(record.id.value);
    if (record.reason == Pipeline::kDropped) {
      progress.Say(fmt::format("frame {} dropped: tracking is behind", frames[position]));
    }
    if (!result.first_pose_seconds && record.status == FrameStatus::kTracked) {
      result.first_pose_seconds = SecondsSinceProcessStart();
    }
    views.Offer(position, view);
    progress.Show(record);
  });
  const auto keeping_failure = [&](const auto& step) {
    try {
      step();
    } catch (const InputError& error) {
      if (!result.failure) result.failure = error;
    }
  };
  keeping_failure([&] { FeedFrames(dataset, frames, setup, progress, pipeline); });
  keeping_failure([&] { pipeline.Finish(); });
  if (result.failure && system.frames().empty()) throw InputError(*result.failure);
  return result;
}

void PrintResult(const System& system, const Dataset& dataset, const RunSetup& setup) {
  const RunCounts counts = CountRun(system);
  std::cout << fmt::format(
      "frames {}: {} tracked, {} lost, {} skipped{}{}\n",
      counts.frames,
      counts.tracked,
      counts.lost,
      counts.skipped,
      counts.dropped > 0 ? fmt::format(" ({} dropped)", counts.dropped) : std::string(),
      counts.initializing > 0 ? fmt::format(", {} before a map", counts.initializing)
                              : std::string());
  std::cout << fmt::format(
      "map: {} keyframes, {} points, {} lines{}\n",
      counts.keyframes,
      counts.points,
      counts.lines,
      counts.maps > 1 ? fmt::format(" (largest of {} maps)", counts.maps) : std::string());
  if (const auto error = CompareWithGroundTruth(system, dataset)) {
    const double scale = error->reference_from_estimate.scale;
    const bool mono = dataset.sensor() == SensorKind::kMono;
    std::cout << fmt::format("ATE {:.4f} m RMSE{} over {} poses, coverage {:.1f} %\n",
                             error->ate.rmse,
                             mono ? fmt::format(" (scale {:.4g})", scale) : std::string(),
                             error->poses.size(),
                             100.0 * counts.tracked / std::max(counts.frames, 1));
  } else if (counts.tracked > 0) {
    std::cout << (dataset.info().ground_truth ? "no errors: the ground truth covers no pose\n"
                                              : "no errors: no ground truth with the data\n");
  }
  std::cout << "results in " << Printable(setup.folder.string(), kLongestMessage) << '\n';
}

}  // namespace

int RunCommand(std::span<const std::string> arguments) {
  const CommandLine line(Syntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(Syntax());
    return 0;
  }
  const auto start = Clock::now();
  const RunSetup setup = ReadSetup(line);
  const auto [dataset, frames] = OpenInput(line);
  MakeFolder(setup.folder);
  RemoveEarlierRun(setup.folder);
  WriteFileAtomically(setup.folder / "options.yaml", setup.options_yaml);
  if (!setup.quiet) {
    for (const std::string& note : dataset->info().notes)
      std::cerr << "plumbline: " << Printable(note, kLongestMessage) << '\n';
  }
  CatchStopSignals();
  System system(dataset->calibration(), setup.options);
  KeptViews views(frames);
  const Progressed progressed = ProcessFrames(*dataset, frames, setup, system, views);

  const auto samples = views.Write(setup.folder);
  WriteRunFiles(system, setup.folder, dataset->info().time_mirror_ns);
  ResourceUse resources = MeasureResources();
  resources.first_pose_seconds = progressed.first_pose_seconds;
  resources.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const RunDescription description{PLUMBLINE_VERSION,
                                   line.Positional(0),
                                   setup.options_yaml,
                                   setup.options.slam.seed,
                                   {arguments.begin(), arguments.end()}};
  WriteFileAtomically(setup.folder / "summary.json",
                      FormatSummary(description, system, *dataset, resources));
  WriteHtmlReport(system, *dataset, {description, resources, {}, samples}, setup.folder);
  if (!setup.quiet) PrintResult(system, *dataset, setup);
  if (progressed.failure) throw InputError(*progressed.failure);
  return 0;
}

}  // namespace plumbline
