// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/cutting/cut_lines.h"

#include "tests/cutting/random_lines.h"

#include <benchmark/benchmark.h>

// Cutting the lines of a frame, by method, information and number of lines. Arguments: lines.

namespace plumbline {
namespace {

void Cut(benchmark::State& state, CuttingMethod method, CuttingInformation information) {
  const CuttingProblem problem = RandomProblem(1, static_cast<int>(state.range(0)));
  const CuttingOptions options{method, information};
  for (auto _ : state) benchmark::DoNotOptimize(CutLines(problem, options));
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

}  // namespace
}  // namespace plumbline
