// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/random.h"
#include "plumbline/solvers/essential.h"
#include "plumbline/solvers/homography.h"
#include "plumbline/solvers/pose_refinement.h"
#include "plumbline/solvers/relative_pose.h"

#include "tests/solvers/two_view_scene.h"
#include <array>

#include <benchmark/benchmark.h>

// The solvers of two views: minimal ones, the refinement, and the whole estimate of a relative pose
// (arguments: kind of scene as in two_view_scene.h, matches, percent of wrong ones). 0.5 px of
// noise at a focal length of 500 px.

namespace plumbline {
namespace {

testing::TwoViewScene Scene(testing::SceneKind kind, int points, double outliers) {
  return testing::MakeTwoViewScene(
      1, {.kind = kind, .points = points, .outliers = outliers, .sigma = 0.5 / 500});
}

void FivePoints(benchmark::State& state) {
  const auto scene = Scene(testing::SceneKind::kGeneral, 500, 0);
  std::size_t first = 0;
  std::size_t solutions = 0;
  for (auto _ : state) {
    const std::span<const RayMatch, 5> sample(&scene.matches[first], 5);
    const auto found = EssentialFromFivePoints(sample);
    benchmark::DoNotOptimize(found.data());
    solutions += found.size();
    first = (first + 5) % 500;
  }
  state.counters["solutions"] =
      static_cast<double>(solutions) / static_cast<double>(state.iterations());
}

void FourPoints(benchmark::State& state) {
  const auto scene = Scene(testing::SceneKind::kPlane, 500, 0);
  std::size_t first = 0;
  for (auto _ : state) {
    const std::span<const RayMatch, 4> sample(&scene.matches[first], 4);
    benchmark::DoNotOptimize(HomographyFromFourPoints(sample));
    first = (first + 4) % 500;
  }
}

void Refinement(benchmark::State& state) {
  const auto scene = Scene(testing::SceneKind::kGeneral, static_cast<int>(state.range(0)), 0.2);
  RefinedPose refined;
  for (auto _ : state) {
    refined = RefinePose(scene.matches, scene.b_from_a);
    benchmark::DoNotOptimize(refined);
  }
  state.counters["iterations"] = refined.iterations;
}

void RelativePoses(benchmark::State& state) {
  const auto scene = Scene(static_cast<testing::SceneKind>(state.range(0)),
                           static_cast<int>(state.range(1)),
                           static_cast<double>(state.range(2)) / 100);
  std::uint64_t seed = 0;
  std::size_t hypotheses = 0;
  for (auto _ : state) {
    Rng rng(1, "bench", seed++);
    hypotheses += EstimateRelativePoses(scene.matches, {}, rng).size();
  }
  state.counters["hypotheses"] =
      static_cast<double>(hypotheses) / static_cast<double>(state.iterations());
}

BENCHMARK(FivePoints)->Unit(benchmark::kMicrosecond);
BENCHMARK(FourPoints)->Unit(benchmark::kMicrosecond);
BENCHMARK(Refinement)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(RelativePoses)
    ->ArgsProduct({{0, 1, 2, 3, 4}, {300}, {20}})
    ->Args({0, 300, 0})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plumbline
