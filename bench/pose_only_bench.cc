// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_only.h"

#include "tests/optimization/pose_scene.h"

#include <benchmark/benchmark.h>

namespace plumbline {
namespace {

// Arguments: points, line measurements, percent of outliers, start error [1/1000 rad, 1/100 m].
void PoseOnly(benchmark::State& state) {
  const double start = static_cast<double>(state.range(3));
  const auto scene = testing::MakePoseScene(1,
                                            {.points = static_cast<int>(state.range(0)),
                                             .lines = static_cast<int>(state.range(1)) / 2,
                                             .sigma = 1,
                                             .outliers = static_cast<double>(state.range(2)) / 100,
                                             .rotation_error = start / 1000,
                                             .translation_error = start / 100});
  PoseOnlyResult result;
  for (auto _ : state) {
    result = SolvePose(scene.problem);
    benchmark::DoNotOptimize(result);
  }
  state.counters["iterations"] = result.iterations;
  state.counters["inlier_points"] = result.inlier_points;
  state.counters["inlier_lines"] = result.inlier_line_groups;
}
BENCHMARK(PoseOnly)
    ->Args({300, 80, 0, 5})
    ->Args({300, 80, 10, 5})
    ->Args({300, 80, 30, 5})
    ->Args({300, 80, 30, 30})
    ->Args({1000, 200, 10, 5})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plumbline
