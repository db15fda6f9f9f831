// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ceres_terms.h"
#include "plumbline/optimization/local_ba.h"

#include "tests/optimization/ba_scene.h"

#include <benchmark/benchmark.h>

namespace plumbline {
namespace {

// Arguments of all benchmarks: keyframes, free ones among them, points, lines. 6 views per
// landmark, 1 px of noise, 3 % outliers, Huber loss, one round.
BaProblem MakeProblem(const benchmark::State& state) {
  return testing::MakeBaScene(1,
                              {.poses = static_cast<int>(state.range(0)),
                               .free_poses = static_cast<int>(state.range(1)),
                               .points = static_cast<int>(state.range(2)),
                               .lines = static_cast<int>(state.range(3)),
                               .sigma = 1,
                               .outliers = 0.03})
      .problem;
}

const LocalBaOptions kDefaults;
const HuberThresholds kHuber{
    kDefaults.huber_point, kDefaults.huber_disparity, kDefaults.huber_line};

void Report(benchmark::State& state, double cost, int iterations) {
  state.counters["cost"] = cost;
  state.counters["iterations"] = iterations;
  state.counters["per_iteration"] = benchmark::Counter(
      iterations, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void RunOurs(benchmark::State& state, const LocalBaOptions& options) {
  const BaProblem problem = MakeProblem(state);
  BaResult result;
  for (auto _ : state) {
    result = SolveLocalBa(problem, options);
    benchmark::DoNotOptimize(result);
  }
  Report(state, result.final_cost, result.iterations);
}

void RunCeres(benchmark::State& state, const CeresBaOptions& options) {
  const BaProblem problem = MakeProblem(state);
  CeresBaResult result;
  for (auto _ : state) {
    result = SolveWithCeres(problem, options);
    benchmark::DoNotOptimize(result);
  }
  Report(state, result.final_cost, result.iterations);
}

// Both until the cost falls by less than 1e-4 of itself.
void Converge(benchmark::State& state) {
  RunOurs(state, {.rounds = 1, .max_iterations = 50, .function_tolerance = 1e-4});
}
void ConvergeCeres(benchmark::State& state) {
  RunCeres(state, {.huber = kHuber, .max_iterations = 50, .function_tolerance = 1e-4});
}
// Ten iterations each.
void TenIterations(benchmark::State& state) {
  RunOurs(state, {.rounds = 1, .max_iterations = 10, .function_tolerance = 0});
}
void TenIterationsCeres(benchmark::State& state) {
  RunCeres(state, {.huber = kHuber, .max_iterations = 10, .function_tolerance = 0});
}
void TenIterationsCeresAutomatic(benchmark::State& state) {
  RunCeres(state,
           {.huber = kHuber,
            .derivatives = CeresDerivatives::kAutomatic,
            .max_iterations = 10,
            .function_tolerance = 0});
}
// With the default options: two rounds with rejection between.
void Default(benchmark::State& state) { RunOurs(state, {}); }

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)
      ->Args({15, 10, 2000, 300})
      ->Args({15, 10, 2000, 0})
      ->Args({40, 30, 5000, 1000});
}
BENCHMARK(Converge)->Apply(Sizes);
BENCHMARK(ConvergeCeres)->Apply(Sizes);
BENCHMARK(TenIterations)->Apply(Sizes);
BENCHMARK(TenIterationsCeres)->Apply(Sizes);
BENCHMARK(TenIterationsCeresAutomatic)->Apply(Sizes);
BENCHMARK(Default)->Apply(Sizes);

}  // namespace
}  // namespace plumbline
