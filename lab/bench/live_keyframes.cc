// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Number of keyframes of a live run, and its dependence on the machine: live_keyframes SEQUENCE
// [--sensor mono|stereo|rgbd] [--mapping-ms 0,50,100,200,400] [--from 0] [--frames 0] [--set
// KEY=VALUE]...
//
// The sequence is played at its own rate against a clock moved by this program: a frame is tracked
// at its arrival, and mapping takes the given milliseconds for each keyframe (and sheds work if
// three wait), whatever the processor. Figures are therefore reproducible. Features are extracted
// once for all runs. The row "inline" is a run whose mapping is part of the algorithm (slam.lag).
// Prints a Markdown table: keyframes made, dropped, and in the map at the end, points, frames with
// a pose, and errors of the final and the causal trajectory.
#include "lab/bench/replay_arguments.h"
#include "lab/bench/run_bench.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/report/error_options.h"
#include "plumbline/report/trajectory_error.h"
#include "plumbline/slam/load_control.h"
#include "plumbline/slam/system.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

struct Setup {
  std::filesystem::path sequence;
  std::optional<SensorKind> sensor;
  std::vector<int> mapping_ms = {0, 50, 100, 200, 400};
  std::size_t from = 0;
  std::size_t frames = 0;  // so many; 0: all
  std::vector<std::string> settings;
};

std::vector<int> ParseCounts(const std::string& name, const std::string& text) {
  std::vector<int> counts;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) counts.push_back(ParseCount(name, part));
  return counts;
}

Setup ReadSetup(int count, char** arguments) {
  Setup setup;
  if (count < 2) throw InputError("expected the folder of a sequence");
  setup.sequence = arguments[1];
  for (int i = 2; i < count; i += 2) {
    const std::string name = arguments[i];
    if (i + 1 == count) throw InputError(name + ": expected a value after it");
    const std::string value = arguments[i + 1];
    if (name == "--sensor") {
      setup.sensor = ParseSensor(value);
    } else if (name == "--mapping-ms") {
      setup.mapping_ms = ParseCounts(name, value);
    } else if (name == "--from") {
      setup.from = static_cast<std::size_t>(ParseCount(name, value));
    } else if (name == "--frames") {
      setup.frames = static_cast<std::size_t>(ParseCount(name, value));
    } else if (name == "--set") {
      setup.settings.push_back(value);
    } else {
      throw InputError(name + ": no such option");
    }
  }
  return setup;
}

// A frame of the sequence; without features if its image cannot be read.
struct Measured {
  std::int64_t stamp_ns = 0;
  std::shared_ptr<const FrameFeatures> indexed;
};

class LiveKeyFrames {
 public:
  explicit LiveKeyFrames(const Setup& setup)
      : setup_(setup), dataset_(OpenDataset(setup.sequence, {.sensor = setup.sensor})) {
    OptionTable table(options_);
    for (const std::string& setting : setup.settings) table.Set(setting);
    if (dataset_->info().ground_truth) {
      truth_ = dataset_->info().ground_truth->OfCamera(dataset_->calibration());
    }
    MeasureAll();
  }

  void Play() {
    fmt::print(
        "| mapping of a keyframe [ms] | decided | given up | in the map | points | tracked | ATE "
        "[mm] | causal [mm] |\n|---|---|---|---|---|---|---|---|\n");
    options_.slam.mode = RunMode::kInline;
    System with_lag(dataset_->calibration(), options_);
    for (const Measured& frame : frames_) Track(frame, with_lag);
    Print("inline", with_lag.Finish());
    options_.slam.mode = RunMode::kLive;
    for (const int mapping_ms : setup_.mapping_ms) PlayLive(mapping_ms);
  }

 private:
  void MeasureAll() {
    const System system(dataset_->calibration(), options_);
    const std::size_t count = dataset_->size();
    const std::size_t end =
        setup_.frames == 0 ? count : std::min(count, setup_.from + setup_.frames);
    for (std::size_t i = setup_.from; i < end; ++i) {
      Measured frame{dataset_->stamp_ns(i), nullptr};
      if (auto read = dataset_->Read(i)) frame.indexed = system.Extract(*std::move(read)).indexed;
      frames_.push_back(std::move(frame));
    }
  }

  static void Track(const Measured& frame, System& system, LoadLevel shed = LoadLevel::kNothing) {
    if (frame.indexed == nullptr) {
      system.Skip(frame.stamp_ns, "unreadable");
      return;
    }
    ExtractedFrame extracted;
    extracted.stamp_ns = frame.stamp_ns;
    extracted.indexed = frame.indexed;
    extracted.shed = shed;
    system.Track(std::move(extracted));
    system.Complete();
  }

  // Mapping begins with a keyframe when one waits and it is done with the one before.
  void PlayLive(int mapping_ms) {
    const std::int64_t mapping_ns = std::int64_t{1'000'000} * mapping_ms;
    System system(dataset_->calibration(), options_, {.threads = false});
    LoadControl shedding;
    std::optional<std::int64_t> done_ns;  // with the keyframe that mapping is at
    for (const Measured& frame : frames_) {
      while (done_ns && *done_ns <= frame.stamp_ns) {
        system.MapOnce();
        const std::int64_t free_ns = *done_ns;
        done_ns.reset();
        if (system.TasksWaiting() > 0) done_ns = free_ns + mapping_ns;
      }
      const auto waiting = static_cast<int>(system.TasksWaiting());
      Track(frame, system, shedding.Next({.tasks_waiting = waiting}));
      if (!done_ns && system.TasksWaiting() > 0) done_ns = frame.stamp_ns + mapping_ns;
    }
    Print(std::to_string(mapping_ms), system.Finish());
  }

  std::optional<double> Error(const Trajectory& estimate) const {
    const auto error = CompareTrajectories(
        truth_, estimate, ErrorOptionsFor(dataset_->sensor(), dataset_->info().format));
    if (!error) return std::nullopt;
    return 1e3 * error->ate.rmse;
  }

  void Print(const std::string& name, const RunResult& result) {
    int decided = 0, given_up = 0, tracked = 0;
    for (const FrameRecord& record : result.frames) {
      decided += record.keyframe || record.demoted;
      given_up += record.demoted;
      tracked += record.status == FrameStatus::kTracked;
    }
    const auto main = result.MainMap();
    if (!main) {
      fmt::print("| {} | {} | {} | no map |\n", name, decided, given_up);
      return;
    }
    const Map& map = result.atlas.maps().at(*main);
    const auto text = [](const std::optional<double>& error) {
      return error ? fmt::format("{:.2f}", *error) : std::string("-");
    };
    fmt::print("| {} | {} | {} | {} | {} | {} of {} | {} | {} |\n",
               name,
               decided,
               given_up,
               map.keyframes().size(),
               map.points().size(),
               tracked,
               result.frames.size(),
               text(Error(result.FinalTrajectory(*main))),
               text(Error(result.CausalTrajectory(*main))));
    std::fflush(stdout);
  }

  Setup setup_;
  SlamOptions options_;
  std::unique_ptr<Dataset> dataset_;
  std::vector<Measured> frames_;
  Trajectory truth_;
};

}  // namespace
}  // namespace plumbline

int main(int count, char** arguments) {
  return plumbline::bench::RunBench("live_keyframes", [&] {
    plumbline::LiveKeyFrames(plumbline::ReadSetup(count, arguments)).Play();
  });
}
