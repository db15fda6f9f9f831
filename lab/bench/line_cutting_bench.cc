// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/choose_features.h"

#include "tests/line_cutting/random_points.h"

#include <benchmark/benchmark.h>

// Cutting the lines of a frame, by method, information and number of lines. Arguments: lines.
// Choosing points and lines together. Arguments: points, lines, budget.

namespace plumbline {
namespace {

void Cut(benchmark::State& state, CuttingMethod method, CuttingInformation information) {
  const CuttingProblem problem = RandomProblem(1, static_cast<int>(state.range(0)));
  const CuttingRecipe recipe{method, information};
  for (auto _ : state) benchmark::DoNotOptimize(CutLinesBy(recipe, problem));
}

void Choose(benchmark::State& state, CuttingMethod method) {
  const CuttingProblem problem = RandomProblem(1, static_cast<int>(state.range(1)));
  const auto points = RandomPoints(1, static_cast<int>(state.range(0)));
  const auto budget = static_cast<std::size_t>(state.range(2));
  for (auto _ : state) {
    benchmark::DoNotOptimize(ChooseFeatures(problem, points, budget, {method}));
  }
}

void Sizes(benchmark::internal::Benchmark* bench) {
  for (const int lines : {10, 30, 60, 100, 200, 300}) bench->Arg(lines);
  bench->Unit(benchmark::kMicrosecond);
}

BENCHMARK_CAPTURE(Cut, greedy, CuttingMethod::kGreedy, CuttingInformation::kIndependent)
    ->Apply(Sizes);
BENCHMARK_CAPTURE(Cut,
                  greedy_sweeps,
                  CuttingMethod::kGreedySweeps,
                  CuttingInformation::kIndependent)
    ->Apply(Sizes);
BENCHMARK_CAPTURE(Cut, joint, CuttingMethod::kJoint, CuttingInformation::kIndependent)
    ->Apply(Sizes);
BENCHMARK_CAPTURE(Cut, drop, CuttingMethod::kDrop, CuttingInformation::kIndependent)->Apply(Sizes);
BENCHMARK_CAPTURE(Cut, greedy_printed, CuttingMethod::kGreedy, CuttingInformation::kPrinted)
    ->Apply(Sizes);
BENCHMARK_CAPTURE(Cut, greedy_correlated, CuttingMethod::kGreedy, CuttingInformation::kCorrelated)
    ->Apply(Sizes);
BENCHMARK_CAPTURE(Choose, whole, CuttingMethod::kNone)
    ->Args({200, 60, 40})
    ->Args({200, 60, 100})
    ->Args({500, 150, 100})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Choose, greedy, CuttingMethod::kGreedy)
    ->Args({200, 60, 40})
    ->Args({200, 60, 100})
    ->Args({500, 150, 100})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plumbline
