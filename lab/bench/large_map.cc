// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// CPU time of operations that may grow with the map, on generated drives: large_map
// straight|chain|hub|rounds KEYFRAMES... For each: the steps of mapping a keyframe at the end of
// the drive and a snapshot, which must not grow, also while there is a copy of the map; the copy,
// which blocks mapping; the change of its stereo correction; the essential graph that verifies a
// loop, anew and after one keyframe; writing and reading its file; the common directions of lines,
// the search for well observed lines, and the final adjustment (--steps: not these; --end: only
// these), which may grow; the largest memory so far.
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/loop_closing/options.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/mapping/line_map.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/mapping/parallel_lines.h"
#include "plumbline/mapping/stereo_calibration.h"

#include "long_drive.h"
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace plumbline {
namespace {

constexpr std::array kShapes = {std::pair{"straight", DriveShape::kStraight},
                                std::pair{"chain", DriveShape::kChain},
                                std::pair{"hub", DriveShape::kHub},
                                std::pair{"rounds", DriveShape::kRounds}};

std::optional<DriveShape> ShapeNamed(std::string_view name) {
  for (const auto& [known, shape] : kShapes) {
    if (name == known) return shape;
  }
  return std::nullopt;
}

// CPU seconds of this process.
template <class Work>
double Measure(const Work& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

double PeakGigabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / (1024.0 * 1024.0);
}

// The largest error of a motion between keyframes that follow each other, in millimetres.
double WorstMotion(const LongDrive& drive) {
  double worst = 0;
  const Rigid3* before = nullptr;
  for (const auto& [id, keyframe] : drive.map.keyframes()) {
    const auto k = static_cast<std::size_t>(id.value);
    const Rigid3& pose = keyframe.frame.cam_from_world;
    if (before != nullptr) {
      const Rigid3 truth = drive.truth[k] * Inverse(drive.truth[k - 1]);
      const Rigid3 error = pose * Inverse(*before) * Inverse(truth);
      worst = std::max(worst, 1000 * error.translation.norm());
    }
    before = &pose;
  }
  return worst;
}

// Takes the last keyframes out of the map; returns them, by age.
std::vector<KeyFrame> TakeOutLast(int count, Map& map) {
  std::vector<KeyFrame> taken;
  for (auto last = map.keyframes().rbegin(); count > 0 && last != map.keyframes().rend(); --count) {
    taken.push_back((last++)->second);
  }
  std::reverse(taken.begin(), taken.end());
  MapEdit edit;
  for (auto keyframe = taken.rbegin(); keyframe != taken.rend(); ++keyframe) {
    edit.push_back(edit::RemoveKeyFrame{keyframe->id});
  }
  map.Apply(edit);
  return taken;
}

// Copies share unchanged parts: a copy of a completely changed map shares nothing.
Map Unshared(const Map& map) {
  Map copy = map;
  edit::MoveKeyFrames motion;
  for (const auto& [id, keyframe] : map.keyframes()) motion.new_from_old.emplace(id, Similarity3());
  copy.Apply({std::move(motion)});
  return copy;
}

// Measures a copy of the whole map, as for background computations, and its release after the whole
// map has changed.
void MeasureCopy(const LongDrive& drive) {
  const Map map = Unshared(drive.map);
  std::optional<Map> copy;
  const double made = Measure([&] { copy.emplace(map); });
  const Map changed = Unshared(*copy);
  const double given_up = Measure([&] { copy.reset(); });
  fmt::print("  copy of the map {:.2f} ms, given up {:.2f} ms\n", 1000 * made, 1000 * given_up);
}

// Mean milliseconds of CPU of mapping a keyframe and of a snapshot, and wall-clock ones of each
// step, over some keyframes. With an unused copy made before the first.
void MeasureSteps(const LongDrive& drive, bool with_copy) {
  constexpr int kKeyFrames = 20;
  Map map = Unshared(drive.map);
  LocalMapper mapper(drive.imaging, {}, {});
  const std::vector<KeyFrame> taken = TakeOutLast(kKeyFrames, map);
  const Map copy = with_copy ? map : Map();
  std::vector<MappingStep> sums;
  double mapped = 0, snapshot = 0;
  KeyFrameId parent = map.keyframes().rbegin()->first;
  for (KeyFrame keyframe : taken) {
    keyframe.id = map.NextKeyFrameId();
    keyframe.parent = std::exchange(parent, keyframe.id);
    std::vector<MappingStep> steps;
    mapped += Measure([&] { steps = mapper.Add(map, keyframe, {}); }) / kKeyFrames;
    sums.resize(steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      sums[i].name = steps[i].name;
      sums[i].milliseconds += steps[i].milliseconds / kKeyFrames;
    }
    snapshot += Measure([&] { TakeSnapshot(map, keyframe.id); }) / kKeyFrames;
  }
  fmt::print("  {}keyframe {:.2f} ms, snapshot {:.2f} ms;",
             with_copy ? "beside a copy " : "",
             1000 * mapped,
             1000 * snapshot);
  for (const MappingStep& step : sums) fmt::print(" {} {:.2f} ms", step.name, step.milliseconds);
  fmt::print("\n");
}

// The longest of the steps in which all keyframes get another stereo correction.
void MeasureStereoChange(const LongDrive& drive) {
  Map map = drive.map;
  StereoChange change;
  change.Begin(map, {drive.imaging.camera, 0.3 * Vector6d::Ones()});
  double longest = 0, all = 0;
  int steps = 0;
  // The last step frees data without keyframes.
  for (bool more = true; more; ++steps) {
    more = change.Running(map);
    const double seconds = Measure([&] { change.Step(map); });
    longest = std::max(longest, seconds);
    all += seconds;
  }
  fmt::print("  another stereo correction in {} steps, {:.1f} ms, the longest {:.1f} ms\n",
             steps,
             1000 * all,
             1000 * longest);
}

// The essential graph of the map: from nothing, after a change of one keyframe, and without
// changes; then its parts for verifying a loop, and for closing it.
void MeasureEssentialGraph(const LongDrive& drive) {
  Map map = Unshared(drive.map);
  const LoopOptions options;
  StrongCovisibility covisible(options.strong_covisibility);
  EssentialGraph graph;
  const auto make = [&] {
    covisible.Follow(map);
    graph = MakeEssentialGraph(map, covisible, false, options.drift);
  };
  const double anew = Measure(make);
  const KeyFrame& newest = map.keyframes().rbegin()->second;
  edit::MoveKeyFrames motion;
  motion.new_from_old.emplace(newest.id, Similarity3());
  map.Apply({std::move(motion)});
  const double after_one = Measure(make);
  const double unchanged = Measure(make);
  const double ways = Measure([&] {
    OdometryWays odometry(graph);
    odometry.Along(static_cast<int>(graph.poses.size()) - 1, 0);
  });
  const double edges = Measure([&] { graph.WithAllEdges(); });
  fmt::print(
      "  essential graph of {} ties {:.1f} ms, after one keyframe {:.1f} ms, unchanged "
      "{:.1f} ms; the way of a loop {:.1f} ms; all edges {:.1f} ms\n",
      graph.ties.size(),
      1000 * anew,
      1000 * after_one,
      1000 * unchanged,
      1000 * ways,
      1000 * edges);
}

// Seconds and bytes of a map file.
void MeasureFile(const LongDrive& drive) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("large_map_{}.plb", ::getpid());
  const double saved = Measure(
      [&] { SaveMap(path, drive.imaging.camera, Eigen::Quaterniond::Identity(), drive.map); });
  const double size = static_cast<double>(std::filesystem::file_size(path));
  std::size_t keyframes = 0;
  const double loaded = Measure([&] { keyframes = LoadMap(path).map.keyframes().size(); });
  std::filesystem::remove(path);
  fmt::print("  file {:.0f} MB, saved in {:.2f} s, loaded in {:.2f} s ({} keyframes)\n",
             1e-6 * size,
             saved,
             loaded,
             keyframes);
}

// Measures the end of a run: the whole map is adjusted twice, and misfits are taken out.
void MeasureEnd(LongDrive& drive) {
  std::size_t directions = 0, lines = 0;
  const double common = Measure([&] { directions = CommonDirections(drive.map).size(); });
  fmt::print("  {} common directions of lines {:.1f} ms\n", directions, 1000 * common);
  const double search =
      Measure([&] { lines = FindWellSeenLines(drive.map, drive.imaging, {}).size(); });
  fmt::print("  {} well seen lines {:.2f} s\n", lines, search);
  const double before = WorstMotion(drive);
  const LocalMapper mapper(drive.imaging, {}, {});
  const double adjust = Measure([&] { mapper.Finish(drive.map); });
  fmt::print("  adjustment, twice {:.2f} s, worst motion {:.0f} -> {:.1f} mm off; {:.1f} GB\n",
             adjust,
             before,
             WorstMotion(drive),
             PeakGigabytes());
}

enum class Part { kAll, kSteps, kEnd };

void Run(std::string_view name, DriveShape shape, int keyframes, Part part) {
  LongDrive drive = MakeLongDrive(shape, keyframes);
  std::size_t observations = 0;
  for (const auto& [id, point] : drive.map.points()) observations += point.observations.size();
  fmt::print("{}, {} keyframes, {} points ({} observations), {} lines; {:.1f} GB\n",
             name,
             keyframes,
             drive.map.points().size(),
             observations,
             drive.map.lines().size(),
             PeakGigabytes());
  if (part != Part::kEnd) {
    MeasureSteps(drive, false);
    MeasureSteps(drive, true);
    MeasureCopy(drive);
    MeasureStereoChange(drive);
    MeasureEssentialGraph(drive);
    MeasureFile(drive);
  }
  if (part != Part::kSteps) MeasureEnd(drive);
}

}  // namespace
}  // namespace plumbline

int main(int count, char** arguments) {
  const auto shape =
      count > 2 ? plumbline::ShapeNamed(arguments[1]) : std::optional<plumbline::DriveShape>();
  if (!shape) {
    fmt::print(stderr, "usage: large_map straight|chain|hub|rounds [--steps|--end] KEYFRAMES...\n");
    return 2;
  }
  const std::string_view option = arguments[2];
  const plumbline::Part part = option == "--steps" ? plumbline::Part::kSteps
                               : option == "--end" ? plumbline::Part::kEnd
                                                   : plumbline::Part::kAll;
  for (int i = part == plumbline::Part::kAll ? 2 : 3; i < count; ++i) {
    plumbline::Run(arguments[1], *shape, std::max(100, std::atoi(arguments[i])), part);
  }
  return 0;
}
