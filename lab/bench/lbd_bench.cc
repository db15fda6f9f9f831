// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/bench/example_image.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/line_detection.h"

#include <benchmark/benchmark.h>

namespace plumbline::bench {
namespace {

// Descriptors of the lines of an image, gradient excluded. "a_line": the mean over them.
void Lbd(benchmark::State& state) {
  const ExampleImage example = MakeExampleImage();
  const GradientImage gradient = ComputeGradient(example.image, kLineBlurPx);
  auto lines = DetectLines(example.image, gradient, example.valid, LineDetector::kDrawing, 200, {});
  for (auto _ : state) {
    DescribeLines(gradient, &lines);
    benchmark::DoNotOptimize(lines);
  }
  state.SetLabel(example.name);
  state.counters["lines"] = static_cast<double>(lines.size());
  state.counters["a_line"] = benchmark::Counter(
      static_cast<double>(lines.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(Lbd)->Unit(benchmark::kMicrosecond);

// Argument: length of the line, pixels.
void LbdOfLength(benchmark::State& state) {
  const ExampleImage example = MakeExampleImage();
  const GradientImage gradient = ComputeGradient(example.image, kLineBlurPx);
  const Eigen::Vector2d middle(0.5 * example.image.width(), 0.5 * example.image.height());
  const Eigen::Vector2d half =
      0.5 * static_cast<double>(state.range(0)) * Eigen::Vector2d(0.8, 0.6);
  std::vector<LineFeature> line(1);
  line[0].segment = {middle - half, middle + half};
  for (auto _ : state) {
    DescribeLines(gradient, &line);
    benchmark::DoNotOptimize(line);
  }
}
BENCHMARK(LbdOfLength)->Unit(benchmark::kMicrosecond)->Arg(26)->Arg(64)->Arg(128)->Arg(300);

}  // namespace
}  // namespace plumbline::bench
