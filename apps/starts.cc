// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/laboratory_methods.h"
#include "lab/starts/sequence_truth.h"
#include "lab/starts/start_bench.h"
#include "lab/starts/start_figures.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/options_io.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/error_options.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/options_without_effect.h"
#include "plumbline/slam/preset.h"
#include "plumbline/version.h"

#include "apps/command_inputs.h"
#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/progress.h"
#include "apps/start_drawing.h"
#include "apps/stop_signal.h"
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLongestStart = 3600;  // seconds of video
constexpr const char* kRecords = "starts.csv";
constexpr const char* kSummary = "summary.json";

CommandSyntax StartsSyntax() {
  return {"starts",
          "Tries to start a monocular map at many frames of a sequence, each by itself, and "
          "compares the maps with\nthe ground truth. Writes starts.csv and summary.json.",
          {"PATH"},
          {{"--camera", "FILE", "camera file, or the name of a built-in camera"},
           {"--preset", "NAME", "the start of a paper's system: rippl"},
           {"--config", "FILE", "options from a YAML file; may be repeated"},
           {"--set", "KEY=VALUE", "one option; may be repeated"},
           {"--seed", "N", "of everything random (0)"},
           {"--from", "N", "first start (0)"},
           {"--every", "N", "from one start to the next, frames (5)"},
           {"--start", "N", "only the start at this frame; may be repeated"},
           {"--seconds", "N", "of video until there must be a map (2)"},
           {"--patience",
            "N",
            "seconds of video until an attempt is given up; a map after --seconds is late (6)"},
           {"--least-parallax",
            "DEG",
            "a map from less true parallax is wrong however small its errors are (0)"},
           {"--draw", "", "write start_<frame>.png of every map: two views with points and lines"},
           {"--poses",
            "FILE",
            "compare with this trajectory of the camera (TUM form) in place of the ground truth"},
           {"--out", "DIR", "folder for the results"},
           {"--quiet", "", "print nothing but errors"}}};
}

struct Setup {
  StartOptions options;
  std::optional<std::string> preset;
  std::string options_yaml;
  std::vector<std::string> without_effect;  // lines of OptionsWithoutEffect
  std::optional<std::string> camera;
  int seed = 0;
  std::filesystem::path folder;
  bool quiet = false;
};

// Returns those options of a preset that a start depends on.
StartOptions OptionsOfPreset(const std::string& name) {
  SlamOptions options;
  OptionTable table(options);
  if (LoadPreset(name, table).needs_stereo) {
    throw InputError("--preset " + name +
                     ": expected a preset for one camera, found one for a stereo pair");
  }
  return {options.features, options.initialization};
}

SlamOptions RunOptionsOf(const StartOptions& start) {
  SlamOptions options;
  options.features = start.features;
  options.initialization = start.initialization;
  return options;
}

Setup ReadStartSetup(const CommandLine& line) {
  Setup setup;
  setup.preset = line.Value("--preset");
  if (setup.preset) setup.options = OptionsOfPreset(*setup.preset);
  const SlamOptions unset = RunOptionsOf(setup.options);
  OptionTable table(setup.options, LaboratoryMethods().added);
  for (const std::string& file : line.Values("--config")) table.LoadFile(file);
  std::vector<std::string> set = DifferentOptions(unset, RunOptionsOf(setup.options));
  for (const std::string& assignment : line.Values("--set")) {
    table.Set(assignment);
    set.push_back(assignment.substr(0, assignment.find('=')));
  }
  setup.without_effect =
      OptionsWithoutEffect(RunOptionsOf(setup.options), set, NameOf(SensorKind::kMono));
  setup.options_yaml = table.Dump();
  setup.camera = line.Value("--camera");
  setup.seed = line.Count("--seed", 0, {0, std::numeric_limits<int>::max()});
  const auto folder = line.Value("--out");
  if (!folder) throw InputError("starts: expected --out DIR");
  setup.folder = *folder;
  setup.quiet = line.Has("--quiet");
  return setup;
}

double ReadParallax(const CommandLine& line) {
  const auto text = line.Value("--least-parallax");
  if (!text) return 0;
  const auto number = ParseNumber(*text);
  if (!number || *number < 0 || *number > 180) {
    throw InputError("--least-parallax: expected a number from 0 to 180, found " +
                     Printable(*text));
  }
  return *number;
}

// The poses that the user gives, some of which must be at the times of frames.
Trajectory ReadPoses(const std::filesystem::path& path, const Dataset& dataset) {
  Trajectory poses = ReadTrajectory(path).poses;
  const std::vector<std::int64_t>& stamps = dataset.info().stamps_ns;
  const std::int64_t max_gap_ns =
      ErrorOptionsFor(dataset.sensor(), dataset.info().format).max_gap_ns;
  const bool common = std::any_of(stamps.begin(), stamps.end(), [&](std::int64_t stamp_ns) {
    return InterpolateAt(poses, stamp_ns, max_gap_ns).has_value();
  });
  if (common || stamps.empty()) return poses;
  throw InputError(
      fmt::format("--poses {}: no frame has a pose at its time: the poses cover {} to {}, the "
                  "frames {} to {}",
                  path.string(),
                  FormatStamp(poses.front().stamp_ns),
                  FormatStamp(poses.back().stamp_ns),
                  FormatStamp(stamps.front()),
                  FormatStamp(stamps.back())));
}

StartPlan ReadPlan(const CommandLine& line, const Dataset& dataset) {
  StartPlan plan;
  plan.seconds = line.Count("--seconds", static_cast<int>(plan.seconds), {1, kLongestStart});
  plan.patience = line.Count("--patience", static_cast<int>(plan.patience), {1, kLongestStart});
  plan.limits.parallax_deg = ReadParallax(line);
  const int from = line.Count("--from", 0, {0, kMostFrames});
  plan.frames = EveryStart(dataset.size(), from, line.Count("--every", 5, {1, kMostFrames}));
  if (const auto path = line.Value("--poses")) plan.poses = ReadPoses(*path, dataset);
  if (plan.frames.empty()) {
    throw InputError(fmt::format(
        "--from {}: expected a frame with one behind it; there are {}", from, dataset.size()));
  }
  if (!line.Has("--start")) return plan;
  plan.frames.clear();
  const int last = static_cast<int>(dataset.size()) - 2;  // that has a frame behind it
  for (const std::string& text : line.Values("--start")) {
    plan.frames.push_back(ParseCount("--start", text, {0, last}));
  }
  std::sort(plan.frames.begin(), plan.frames.end());
  return plan;
}

nlohmann::ordered_json Figures(const StartResults& results) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, value] : FiguresOf(results.records)) json[name] = value;
  return json;
}

std::string FormatSummary(const Setup& setup,
                          const std::string& sequence,
                          const StartResults& results,
                          double wall_seconds) {
  nlohmann::ordered_json json = {{"version", PLUMBLINE_VERSION},
                                 {"sequence", sequence},
                                 {"seed", setup.seed},
                                 {"starts", Figures(results)}};
  if (!results.add_ms.empty()) {
    json["add"] = {{"median_ms", Percentile(results.add_ms, 0.5)},
                   {"p95_ms", Percentile(results.add_ms, 0.95)},
                   {"max_ms", Percentile(results.add_ms, 1)}};
  }
  json["wall_seconds"] = wall_seconds;
  json["preset"] =
      setup.preset ? nlohmann::ordered_json(*setup.preset) : nlohmann::ordered_json(nullptr);
  json["options"] = setup.options_yaml;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void PrintResult(const StartResults& results, const Setup& setup) {
  const auto figures = FiguresOf(results.records);
  const auto figure = [&](const char* name) {
    const auto found = figures.find(name);
    return found == figures.end() ? std::string("unknown") : fmt::format("{:.4g}", found->second);
  };
  std::cout << fmt::format(
      "{} starts, {} possible: {} % right, {} late, {} wait; {} wrong of all; {} frames to a map\n"
      "results in {}\n",
      figure("starts"),
      figure("possible"),
      figure("success"),
      figure("late"),
      figure("waiting"),
      figure("wrong"),
      figure("map_frames"),
      setup.folder.string());
}

void DrawMaps(const Dataset& dataset, const Setup& setup, StartPlan& plan) {
  const Rectifier rectifier(dataset.calibration());
  plan.on_map = [&setup, camera = rectifier.camera()](const StartRecord& start,
                                                      const InitialMap& map) {
    WriteStartDrawing(map, camera, setup.folder / fmt::format("start_{:06d}.png", start.frame));
  };
}

StartResults Run(const Dataset& dataset, const Setup& setup, const StartPlan& plan) {
  const auto make_initializer = [&setup](const CameraAndPyramid& imaging) {
    return LaboratoryMethods().make_initializer(
        imaging, setup.options.initialization, static_cast<std::uint64_t>(setup.seed), nullptr);
  };
  Countdown progress("starts", plan.frames.size(), setup.quiet);
  return RunStarts(
      dataset, setup.camera, setup.options, plan, make_initializer, [&](std::size_t done) {
        progress.Show(done);
        return !StopRequested();
      });
}

// Returns true if an earlier call wrote the results of a folder, by the beginning of its
// starts.csv.
bool HasStarts(const std::filesystem::path& folder) {
  return FileBeginsWith(folder / kRecords, FormatStarts({}));
}

// Files that the command would replace must be of an earlier call.
void RefuseFilesOfOthers(const std::filesystem::path& folder) {
  static const std::regex written(R"(starts\.csv|summary\.json|start_[0-9]{6,}\.png)");
  if (HasStarts(folder)) return;
  RefuseForeignFiles(folder, "call of starts", [](const std::string& name) {
    return std::regex_match(name, written);
  });
}

// The folder for the results. With drawings it has starts.csv from the beginning, so that they are
// recognized as results of this command even if it is killed.
void PrepareFolder(const Setup& setup, bool draws) {
  MakeFolder(setup.folder);
  for (const char* file : {kRecords, kSummary}) CheckWritable(setup.folder / file);
  if (!draws || HasStarts(setup.folder)) return;
  WriteFileAtomically(setup.folder / kRecords, FormatStarts({}));
}

}  // namespace

int StartsCommand(std::span<const std::string> arguments) {
  const CommandLine line(StartsSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(StartsSyntax());
    return 0;
  }
  const auto began = Clock::now();
  const Setup setup = ReadStartSetup(line);
  const auto dataset =
      OpenDataset(line.Positional(0), {.sensor = SensorKind::kMono, .camera = setup.camera});
  if (!dataset->info().ground_truth && !line.Has("--poses")) {
    throw InputError(dataset->info().ground_truth_fault.value_or(
        dataset->info().path.string() + ": expected ground truth, found none"));
  }
  StartPlan plan = ReadPlan(line, *dataset);
  CheckApart(setup.folder, CommandInputs(line, *dataset));
  RefuseFilesOfOthers(setup.folder);
  PrepareFolder(setup, line.Has("--draw"));
  for (const std::string& note : setup.without_effect) {
    if (!setup.quiet) std::clog << "plumbline: " << note << '\n';
  }
  if (line.Has("--draw")) DrawMaps(*dataset, setup, plan);
  CatchStopSignals();
  const StartResults results = Run(*dataset, setup, plan);
  const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
  WriteFileAtomically(setup.folder / kRecords, FormatStarts(results.records));
  WriteFileAtomically(setup.folder / kSummary,
                      FormatSummary(setup, dataset->info().name, results, seconds));
  if (!setup.quiet) PrintResult(results, setup);
  if (const auto signal = FirstStopSignal()) return signal->exit_code;
  return results.records.size() == plan.frames.size() ? 0 : 1;
}

}  // namespace plumbline
