// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_solve.h"
#include "lab/line_rivals/rival_ba.h"

#include "tests/optimization/ba_scene.h"

#include <benchmark/benchmark.h>

// Local bundle adjustment: ours and Ceres, lines by four parameters and by end points. Meaning of
// the numbers, and results: docs/benchmarks.md.

namespace plumbline {
namespace {

// Arguments of all benchmarks: fixed and free keyframes, points, lines. 6 views per landmark (two
// thirds of them with disparity or right line), 1 px of noise, 3 % outliers, Huber loss.
testing::BaSceneOptions SceneOptions(const benchmark::State& state) {
  return {.poses = static_cast<int>(state.range(0) + state.range(1)),
          .free_poses = static_cast<int>(state.range(1)),
          .points = static_cast<int>(state.range(2)),
          .lines = static_cast<int>(state.range(3)),
          .sigma = 1,
          .outliers = 0.03};
}
BaProblem MakeProblem(const benchmark::State& state) {
  return testing::MakeBaScene(1, SceneOptions(state)).problem;
}
// Half of the lines are seen from two poses only and placed anyhow, many near an epipolar plane.
BaProblem MakeProblemWithWeakLines(const benchmark::State& state) {
  testing::BaSceneOptions options = SceneOptions(state);
  options.weak_lines = options.lines / 2;
  options.lines -= options.weak_lines;
  return testing::MakeBaScene(1, options).problem;
}

// One round, until the cost falls by less than 1e-4 of itself; the limits are those of local
// mapping and, for large problems, one that is not reached.
constexpr int kMaxIterations = 10;
constexpr int kManyIterations = 60;
constexpr double kTolerance = 1e-4;

template <class Solve>
void Run(benchmark::State& state, const Solve& solve) {
  double cost = 0;
  int iterations = 0;
  for (auto _ : state) {
    const auto result = solve();
    cost = result.final_cost;
    iterations = result.iterations;
  }
  state.counters["cost"] = cost;
  state.counters["iterations"] = iterations;
}

void RunOurs(benchmark::State& state,
             const BaProblem& problem,
             LineParametrization lines,
             int max_iterations = kMaxIterations) {
  const LocalBaOptions options{
      .rounds = 1, .max_iterations = max_iterations, .function_tolerance = kTolerance};
  Run(state, [&] { return SolveRivalBa(problem, options, {lines}); });
}

void RunCeres(benchmark::State& state,
              const BaProblem& problem,
              LineParametrization lines,
              int max_iterations = kMaxIterations) {
  const CeresBaOptions options{.huber = kHuberThresholds,
                               .lines = {lines},
                               .max_iterations = max_iterations,
                               .function_tolerance = kTolerance};
  Run(state, [&] { return SolveWithCeres(problem, options); });
}

void Ours(benchmark::State& state, LineParametrization lines) {
  RunOurs(state, MakeProblem(state), lines);
}
void Ceres(benchmark::State& state, LineParametrization lines) {
  RunCeres(state, MakeProblem(state), lines);
}

// From a start not quite as far away: all shall arrive at the same minimum.
BaProblem MakeGrowingProblem(const benchmark::State& state) {
  testing::BaSceneOptions options = SceneOptions(state);
  options.perturbation = 0.3;
  return testing::MakeBaScene(1, options).problem;
}
void OursGrowing(benchmark::State& state, LineParametrization lines) {
  RunOurs(state, MakeGrowingProblem(state), lines, kManyIterations);
}
void CeresGrowing(benchmark::State& state, LineParametrization lines) {
  RunCeres(state, MakeGrowingProblem(state), lines, kManyIterations);
}
void OursWeakLines(benchmark::State& state, LineParametrization lines) {
  RunOurs(state, MakeProblemWithWeakLines(state), lines);
}
void CeresWeakLines(benchmark::State& state, LineParametrization lines) {
  RunCeres(state, MakeProblemWithWeakLines(state), lines);
}

// Ceres without iterations: building its problem, its preprocessing, one evaluation.
void CeresSetUp(benchmark::State& state, LineParametrization lines) {
  const BaProblem problem = MakeProblem(state);
  const CeresBaOptions options{.huber = kHuberThresholds, .lines = {lines}, .max_iterations = 0};
  Run(state, [&] { return SolveWithCeres(problem, options); });
}

// Points of one camera alone: the only case here with Ceres' Schur elimination in fixed block sizes
// (2, 3, 6). With residuals or landmarks of two sizes, its sizes are known at run time only.
BaProblem WithoutDisparity(BaProblem problem) {
  for (auto& o : problem.point_observations) o.measurement.disparity.reset();
  return problem;
}
void OursMonocular(benchmark::State& state) {
  RunOurs(state, WithoutDisparity(MakeProblem(state)), LineParametrization::kPlucker);
}
void CeresMonocular(benchmark::State& state) {
  RunCeres(state, WithoutDisparity(MakeProblem(state)), LineParametrization::kPlucker);
}

// As local mapping calls it: the default options, two rounds with rejection between.
void OursDefault(benchmark::State& state, LineParametrization lines) {
  const BaProblem problem = MakeProblem(state);
  Run(state, [&] { return SolveRivalBa(problem, {}, {lines}); });
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)
      ->ArgNames({"fixed", "free", "points", "lines"})
      ->Args({5, 10, 2000, 300})
      ->Args({5, 10, 2000, 0});
}
void PointsAndLines(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)
      ->ArgNames({"fixed", "free", "points", "lines"})
      ->Args({5, 10, 2000, 300});
}
void PointsOnly(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)
      ->ArgNames({"fixed", "free", "points", "lines"})
      ->Args({5, 10, 2000, 0});
}
BENCHMARK_CAPTURE(Ours, plucker, LineParametrization::kPlucker)->Apply(Sizes);
BENCHMARK_CAPTURE(Ours, endpoints, LineParametrization::kEndpoints)->Apply(Sizes);
BENCHMARK_CAPTURE(Ceres, plucker, LineParametrization::kPlucker)->Apply(Sizes);
BENCHMARK_CAPTURE(Ceres, endpoints, LineParametrization::kEndpoints)->Apply(Sizes);
BENCHMARK_CAPTURE(OursWeakLines, plucker, LineParametrization::kPlucker)->Apply(PointsAndLines);
BENCHMARK_CAPTURE(OursWeakLines, endpoints, LineParametrization::kEndpoints)->Apply(PointsAndLines);
BENCHMARK_CAPTURE(CeresWeakLines, plucker, LineParametrization::kPlucker)->Apply(PointsAndLines);
BENCHMARK_CAPTURE(CeresWeakLines, endpoints, LineParametrization::kEndpoints)
    ->Apply(PointsAndLines);
BENCHMARK_CAPTURE(CeresSetUp, plucker, LineParametrization::kPlucker)->Apply(Sizes);
BENCHMARK_CAPTURE(OursDefault, plucker, LineParametrization::kPlucker)->Apply(PointsAndLines);
BENCHMARK_CAPTURE(OursDefault, endpoints, LineParametrization::kEndpoints)->Apply(PointsAndLines);
BENCHMARK(OursMonocular)->Apply(PointsOnly);
BENCHMARK(CeresMonocular)->Apply(PointsOnly);

// The figure of time against size: everything in proportion to the free keyframes.
void Grow(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->ArgNames({"fixed", "free", "points", "lines"});
  for (const int free : {5, 10, 20, 40, 80}) {
    benchmark->Args({(free + 1) / 2, free, 200 * free, 30 * free});
  }
}
BENCHMARK_CAPTURE(OursGrowing, plucker, LineParametrization::kPlucker)->Apply(Grow);
BENCHMARK_CAPTURE(OursGrowing, endpoints, LineParametrization::kEndpoints)->Apply(Grow);
BENCHMARK_CAPTURE(CeresGrowing, plucker, LineParametrization::kPlucker)->Apply(Grow);
BENCHMARK_CAPTURE(CeresGrowing, endpoints, LineParametrization::kEndpoints)->Apply(Grow);

}  // namespace
}  // namespace plumbline
