// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_solve.h"
#include "plumbline/optimization/pose_optimization.h"

#include "tests/optimization/pose_scene.h"

#include <benchmark/benchmark.h>

// The pose of a frame from matches with known landmarks: ours and Ceres. Meaning of the numbers,
// and results: docs/benchmarks.md.

namespace plumbline {
namespace {

// Arguments: points, line measurements (two for each line), percent of outliers, error of the start
// [1/1000 rad and 1/100 m]. 1 px of noise.
PoseProblem MakeProblem(const benchmark::State& state) {
  const double start = static_cast<double>(state.range(3));
  return testing::MakePoseScene(1,
                                {.points = static_cast<int>(state.range(0)),
                                 .lines = static_cast<int>(state.range(1)) / 2,
                                 .sigma = 1,
                                 .outliers = static_cast<double>(state.range(2)) / 100,
                                 .rotation_error = start / 1000,
                                 .translation_error = start / 100})
      .problem;
}

template <class Solve>
void Run(benchmark::State& state, const Solve& solve) {
  const PoseProblem problem = MakeProblem(state);
  decltype(solve(problem)) result;
  for (auto _ : state) {
    result = solve(problem);
    benchmark::DoNotOptimize(result);
  }
  state.counters["iterations"] = result.iterations;
  state.counters["inlier_points"] = result.inlier_points;
  state.counters["inlier_lines"] = result.inlier_line_groups;
}

// One solve under the Huber loss, then the inliers.
void OursOneRound(benchmark::State& state) {
  Run(state, [](const PoseProblem& problem) {
    return SolvePose(problem, {.rounds = 1, .robust_rounds = 1});
  });
}
void CeresOneRound(benchmark::State& state) {
  Run(state, [](const PoseProblem& problem) {
    return SolvePoseWithCeres(problem,
                              {.huber = kHuberThresholds, .rounds = 1, .robust_rounds = 1});
  });
}
// As tracking does it: four rounds with the inliers chosen anew after each.
void Ours(benchmark::State& state) {
  Run(state, [](const PoseProblem& problem) { return SolvePose(problem); });
}
void Ceres(benchmark::State& state) {
  Run(state, [](const PoseProblem& problem) {
    return SolvePoseWithCeres(problem, {.huber = kHuberThresholds});
  });
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMicrosecond)
      ->ArgNames({"points", "lines", "outliers", "start"})
      ->Args({300, 80, 10, 2})
      ->Args({300, 80, 10, 5});
}
BENCHMARK(OursOneRound)->Apply(Sizes);
BENCHMARK(CeresOneRound)->Apply(Sizes);
BENCHMARK(Ours)->Apply(Sizes);
BENCHMARK(Ceres)->Apply(Sizes);
// From afar and with many outliers, for which Ceres as set up here would not converge.
BENCHMARK(Ours)
    ->ArgNames({"points", "lines", "outliers", "start"})
    ->Args({300, 80, 30, 30})
    ->Args({1000, 200, 10, 5})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plumbline
