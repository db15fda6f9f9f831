// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// CPU time of what grows with the map, on generated drives: large_map straight|chain|hub|rounds
// KEYFRAMES... For each the common directions of lines, the search for well seen lines, and the
// adjustment that ends a run; the largest memory so far.
#include "plumbline/mapping/line_map.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/mapping/parallel_lines.h"

#include "long_drive.h"
#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>

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

// Of the motions between keyframes that follow each other, in millimetres.
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

void Run(std::string_view name, DriveShape shape, int keyframes) {
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
  std::size_t directions = 0, lines = 0;
  const double common = Measure([&] { directions = CommonDirections(drive.map).size(); });
  fmt::print("  {} common directions of lines {:.1f} ms\n", directions, 1000 * common);
  const double search =
      Measure([&] { lines = FindWellSeenLines(drive.map, drive.imaging, {}).size(); });
  fmt::print("  {} well seen lines {:.2f} s\n", lines, search);
  const double before = WorstMotion(drive);
  MappingOptions options;
  const LocalMapper mapper(drive.imaging, {}, options);
  const double adjust = Measure([&] { mapper.Finish(drive.map); });
  fmt::print("  adjustment, twice {:.2f} s, worst motion {:.0f} -> {:.1f} mm off; {:.1f} GB\n",
             adjust,
             before,
             WorstMotion(drive),
             PeakGigabytes());
}

}  // namespace
}  // namespace plumbline

int main(int count, char** arguments) {
  const auto shape =
      count > 2 ? plumbline::ShapeNamed(arguments[1]) : std::optional<plumbline::DriveShape>();
  if (!shape) {
    fmt::print(stderr, "usage: large_map straight|chain|hub|rounds KEYFRAMES...\n");
    return 2;
  }
  for (int i = 2; i < count; ++i) {
    plumbline::Run(arguments[1], *shape, std::max(10, std::atoi(arguments[i])));
  }
  return 0;
}
