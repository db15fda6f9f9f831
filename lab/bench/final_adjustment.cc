// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// This benchmark times the end of a run, by step, on maps that runs left unadjusted
// (--set mapping.final_adjustment_keyframes=0): final_adjustment MAP.plb...
// Prints seconds of each step, and the largest memory so far; writes the adjusted keyframes
// into MAP.txt, beside each map, for `plumbline evaluate`.
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/mapping/local_mapper.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <sys/resource.h>

namespace {

using plumbline::LocalMapper;
using plumbline::Map;
using plumbline::MappingStep;

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Writes the poses of all keyframes as a trajectory in TUM's form.
void WriteKeyFrames(const Map& map, const std::filesystem::path& path) {
  std::ofstream file(path);
  for (const auto& [id, keyframe] : map.keyframes()) {
    const plumbline::Rigid3 pose = plumbline::Inverse(keyframe.frame.cam_from_world);
    const Eigen::Quaterniond& q = pose.rotation;
    file << fmt::format("{}.{:09d} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                        keyframe.frame.stamp_ns / 1'000'000'000,
                        keyframe.frame.stamp_ns % 1'000'000'000,
                        pose.translation.x(),
                        pose.translation.y(),
                        pose.translation.z(),
                        q.x(),
                        q.y(),
                        q.z(),
                        q.w());
  }
}

void Measure(const std::filesystem::path& path) {
  plumbline::SavedMap saved = plumbline::LoadMap(path);
  plumbline::CameraAndPyramid imaging;
  imaging.camera = saved.camera;
  const double before = PeakMegabytes();
  const LocalMapper mapper(imaging, {}, {});
  const std::vector<MappingStep> steps = mapper.Finish(saved.map);
  fmt::print("{}: {} keyframes, {} points, {} lines:",
             path.string(),
             saved.map.keyframes().size(),
             saved.map.points().size(),
             saved.map.lines().size());
  double sum = 0;
  for (const MappingStep& step : steps) {
    fmt::print(" {} {:.2f} s,", step.name, 1e-3 * step.milliseconds);
    sum += 1e-3 * step.milliseconds;
  }
  fmt::print(" all {:.2f} s; {:.0f} -> {:.0f} MB\n", sum, before, PeakMegabytes());
  WriteKeyFrames(saved.map, std::filesystem::path(path).replace_extension(".txt"));
}

}  // namespace

int main(int count, char** arguments) {
  return plumbline::bench::RunBench("final_adjustment", [&] {
    if (count < 2) throw plumbline::InputError("expected MAP...");
    for (int i = 1; i < count; ++i) Measure(arguments[i]);
  });
}
