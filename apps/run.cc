// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/options_io.h"
#include "plumbline/image/box_filter.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/dataset.h"
#include "plumbline/report/overlay.h"
#include "plumbline/report/run_files.h"
#include "plumbline/report/summary.h"
#include "plumbline/slam/system.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kOverlays = 6;
constexpr std::chrono::seconds kLineEvery(5);
constexpr std::chrono::milliseconds kBarEvery(100);

CommandSyntax Syntax() {
  return {"run",
          "Tracks the camera through a recorded sequence and maps what it sees.",
          {"PATH"},
          {{"--sensor", "mono|stereo|rgbd", "default: the richest the data offers"},
           {"--format", "auto|euroc|tum|kitti|images", "default: found out from the folder"},
           {"--camera", "FILE", "camera file, or the name of a built-in camera"},
           {"--config", "FILE", "options from a YAML file; may be repeated"},
           {"--set", "KEY=VALUE", "one option; may be repeated"},
           {"--from", "N", "first frame (default 0)"},
           {"--to", "N", "end before this frame (default: the end)"},
           {"--stride", "N", "every N-th frame (default 1)"},
           {"--blur", "N", "N x N box filter on every input image"},
           {"--mode", "inline", "how the stages run; same as --set slam.mode"},
           {"--seed", "N", "of everything random; same as --set slam.seed"},
           {"--out", "DIR", "folder for the results (default: plumbline_run)"},
           {"--quiet", "", "print nothing but errors"}}};
}

// Set by SIGINT and SIGTERM: the run ends early and writes everything.
volatile std::sig_atomic_t stop_requested = 0;
extern "C" void RequestStop(int) { stop_requested = 1; }

int ParseCount(const CommandLine& line, const std::string& option, int fallback, int min) {
  const auto text = line.Value(option);
  if (!text) return fallback;
  int value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc() || end != text->data() + text->size() || value < min) {
    throw InputError(
        fmt::format("{}: expected a whole number of at least {}, found {}", option, min, *text));
  }
  return value;
}

// The frames to process, by index in the data set.
std::vector<std::size_t> ChooseFrames(const CommandLine& line, const Dataset& dataset) {
  const auto from = static_cast<std::size_t>(ParseCount(line, "--from", 0, 0));
  const auto stride = static_cast<std::size_t>(ParseCount(line, "--stride", 1, 1));
  const auto to = std::min(
      dataset.size(),
      static_cast<std::size_t>(ParseCount(line, "--to", std::numeric_limits<int>::max(), 1)));
  if (from >= to) {
    throw InputError(fmt::format(
        "--from {}: the sequence has {} frames, and --to is {}", from, dataset.size(), to));
  }
  std::vector<std::size_t> frames;
  for (std::size_t i = from; i < to; i += stride) frames.push_back(i);
  return frames;
}

// Shows how far a run is: a bar on a terminal, a line every few seconds elsewhere.
class Progress {
 public:
  Progress(std::size_t total, bool quiet)
      : total_(total), quiet_(quiet), terminal_(isatty(2) != 0) {}

  void Show(std::size_t done, const FrameRecord& frame, std::size_t keyframes) {
    const auto now = Clock::now();
    const bool last = done == total_;
    const auto interval = terminal_ ? Clock::duration(kBarEvery) : Clock::duration(kLineEvery);
    if (quiet_ || (!last && now - shown_ < interval)) return;
    shown_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double fps = static_cast<double>(done) / std::max(seconds, 1e-9);
    const double left = static_cast<double>(total_ - done) / std::max(fps, 1e-9);
    const std::string text =
        fmt::format("{}{}/{} frames  {:.1f} fps  {}  {} keyframes  ETA {:.0f} s",
                    terminal_ ? Bar(done) : std::string(),
                    done,
                    total_,
                    fps,
                    NameOf(frame.status),
                    keyframes,
                    left);
    if (terminal_) {
      std::cerr << '\r' << text << "   " << (last ? "\n" : "") << std::flush;
    } else {
      std::cerr << text << '\n';
    }
  }

  // A message between two lines of progress.
  void Say(const std::string& message) const {
    std::cerr << (terminal_ ? "\n" : "") << "plumbline: " << message << '\n';
  }

 private:
  std::string Bar(std::size_t done) const {
    constexpr std::size_t kWidth = 24;
    const std::size_t filled = kWidth * done / std::max<std::size_t>(total_, 1);
    return "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] ";
  }

  std::size_t total_;
  bool quiet_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
};

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
  setup.options_yaml = table.Dump();
  setup.folder = line.Value("--out").value_or("plumbline_run");
  setup.blur = ParseCount(line, "--blur", 0, 1);
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

// Every image of the frame through the box filter of --blur (0: as it is). Depth stays.
SensorFrame Blurred(SensorFrame frame, int size) {
  if (size <= 1) return frame;
  frame.left = BoxFiltered(frame.left, size);
  if (frame.right) frame.right = BoxFiltered(*frame.right, size);
  return frame;
}

void ProcessFrames(const Dataset& dataset,
                   const std::vector<std::size_t>& frames,
                   const RunSetup& setup,
                   System& system) {
  std::set<std::size_t> with_overlay;
  for (int k = 0; k < kOverlays; ++k) {
    with_overlay.insert(static_cast<std::size_t>(k) * (frames.size() - 1) / (kOverlays - 1));
  }
  Progress progress(frames.size(), setup.quiet);
  std::size_t keyframes = 0;
  for (std::size_t k = 0; k < frames.size() && stop_requested == 0; ++k) {
    auto frame = dataset.Read(frames[k]);
    if (!frame) {
      progress.Say(fmt::format(
          "frame {} skipped: {}: {}", frames[k], frame.error().path.string(), frame.error().why));
      progress.Show(k + 1, system.Skip(dataset.stamp_ns(frames[k]), "image_unreadable"), keyframes);
      continue;
    }
    const FrameRecord& record = system.Process(Blurred(*frame, setup.blur));
    keyframes += record.keyframe;
    if (with_overlay.contains(k)) {
      WriteFeatureOverlay(system.view(),
                          setup.folder / fmt::format("overlay_{:06}.png", frames[k]));
    }
    progress.Show(k + 1, record, keyframes);
  }
  system.Finish();
}

void PrintResult(const System& system, const Dataset& dataset, const RunSetup& setup) {
  const RunCounts counts = CountRun(system);
  std::cout << fmt::format("frames {}: {} tracked, {} lost, {} skipped{}\n",
                           counts.frames,
                           counts.tracked,
                           counts.lost,
                           counts.skipped,
                           counts.initializing > 0
                               ? fmt::format(", {} before a map", counts.initializing)
                               : std::string());
  std::cout << fmt::format(
      "map: {} keyframes, {} points, {} lines{}\n",
      counts.keyframes,
      counts.points,
      counts.lines,
      counts.maps > 1 ? fmt::format(" (largest of {} maps)", counts.maps) : std::string());
  if (const auto error = CompareWithGroundTruth(system, dataset)) {
    std::cout << fmt::format("ATE {:.4f} m RMSE over {} poses, coverage {:.1f} %\n",
                             error->ate.rmse,
                             error->poses.size(),
                             100.0 * counts.tracked / std::max(counts.frames, 1));
  }
  std::cout << "results in " << setup.folder.string() << '\n';
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
  const auto dataset = OpenDataset(line.Positional(0), ReadDatasetOptions(line));
  if (dataset->sensor() == SensorKind::kMono) {
    throw InputError(dataset->info().path.string() +
                     ": monocular sequences cannot be run yet; expected stereo or RGB-D data");
  }
  const std::vector<std::size_t> frames = ChooseFrames(line, *dataset);
  MakeFolder(setup.folder);
  WriteFileAtomically(setup.folder / "options.yaml", setup.options_yaml);
  if (!setup.quiet) {
    for (const std::string& note : dataset->info().notes)
      std::cerr << "plumbline: " << note << '\n';
  }
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  System system(dataset->calibration(), setup.options);
  ProcessFrames(*dataset, frames, setup, system);

  WriteRunFiles(system, setup.folder);
  ResourceUse resources = MeasureResources();
  resources.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  WriteFileAtomically(
      setup.folder / "summary.json",
      FormatSummary(
          {PLUMBLINE_VERSION, line.Positional(0), setup.options_yaml, setup.options.slam.seed},
          system,
          *dataset,
          resources));
  if (!setup.quiet) PrintResult(system, *dataset, setup);
  return 0;
}

}  // namespace plumbline
