// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/bench/example_image.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/line_detection.h"

#include <benchmark/benchmark.h>

namespace plumbline::bench {
namespace {

// Arguments: detector; size at which it looks, percent.
void WholeFrontEnd(benchmark::State& state) {
  const ExampleImage example = MakeExampleImage();
  const auto detector = static_cast<LineDetector>(state.range(0));
  LineDetectionOptions options;
  options.detection_scale = static_cast<double>(state.range(1)) / 100;
  std::size_t lines = 0;
  for (auto _ : state) {
    const GradientImage gradient = ComputeGradient(example.image, kLineBlurPx);
    auto found = DetectLines(example.image, gradient, example.valid, detector, 200, options);
    DescribeLines(gradient, &found);
    lines = found.size();
    benchmark::DoNotOptimize(found);
  }
  state.SetLabel(example.name);
  state.counters["lines"] = static_cast<double>(lines);
}

// The same arguments; the detector alone.
void RawSegments(benchmark::State& state) {
  const ExampleImage example = MakeExampleImage();
  const GradientImage gradient = ComputeGradient(example.image, kLineBlurPx);
  RawSegmentOptions options;
  options.detector = static_cast<LineDetector>(state.range(0));
  options.scale = static_cast<double>(state.range(1)) / 100;
  std::size_t segments = 0;
  for (auto _ : state) {
    const auto found = FindRawSegments(example.image, gradient, options);
    segments = found.size();
    benchmark::DoNotOptimize(found);
  }
  state.SetLabel(example.name);
  state.counters["segments"] = static_cast<double>(segments);
}

void Detectors(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->ArgNames({"detector", "percent"});
  for (const auto& [detector, name] : EnumNames(std::type_identity<LineDetector>{})) {
    for (const int percent : {100, 50}) benchmark->Args({static_cast<int>(detector), percent});
  }
}
BENCHMARK(WholeFrontEnd)->Apply(Detectors);
BENCHMARK(RawSegments)->Apply(Detectors);

}  // namespace
}  // namespace plumbline::bench
