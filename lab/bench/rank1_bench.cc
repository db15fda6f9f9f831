// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/geometric_interpolation.h"
#include "plumbline/initialization/model_selection.h"
#include "plumbline/initialization/rank1_factorization.h"
#include "plumbline/initialization/reconstruction.h"
#include "plumbline/initialization/reconstruction_covariance.h"

#include "tests/initialization/track_scene.h"

#include <benchmark/benchmark.h>

// The parts of one attempt at a monocular start. Arguments: frames after the reference (m), points.

namespace plumbline {
namespace {

testing::TrackScene Scene(const benchmark::State& state, bool plane = false) {
  return testing::MakeTrackScene(1,
                                 testing::CurvedMotion(static_cast<int>(state.range(0))),
                                 {.points = static_cast<int>(state.range(1)),
                                  .plane = plane,
                                  .sigma = 1e-3,
                                  .missed = 0.2,
                                  .outliers = 0.1});
}

std::vector<Rank1View> ViewsOf(const testing::TrackScene& scene) {
  std::vector<Rank1View> views;
  for (std::size_t i = 0; i < scene.tracks.views.size(); ++i) {
    const Rigid3 reference_from_cam = Inverse(scene.truth.cam_from_reference[i]);
    views.push_back({reference_from_cam.rotation,
                     reference_from_cam.translation.normalized(),
                     scene.tracks.views[i].points,
                     scene.tracks.views[i].sigmas});
  }
  return views;
}

void LeadingPairOfMatrix(benchmark::State& state) {
  const testing::TrackScene scene = Scene(state);
  const Rank1Matrix matrix(scene.tracks.reference.points, ViewsOf(scene), 0.02);
  for (auto _ : state) benchmark::DoNotOptimize(LeadingPair(matrix.entries()));
}

// The matrix and its factorization.
void Factorize(benchmark::State& state, int reweighting) {
  const testing::TrackScene scene = Scene(state);
  const std::vector<Rank1View> views = ViewsOf(scene);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        FactorizeRank1(scene.tracks.reference.points, views, {.iterations = reweighting}));
  }
}

// All points into one frame between.
void InterpolateFrame(benchmark::State& state) {
  const testing::TrackScene scene = Scene(state);
  const auto& poses = scene.truth.cam_from_reference;
  InterpolationPoses pair{poses.front(), poses.back()};
  pair.covariance.setIdentity();
  pair.covariance *= 1e-8;
  const FeatureTracks& tracks = scene.tracks;
  for (auto _ : state) {
    const GeometricInterpolation interpolation(pair);
    for (std::size_t k = 0; k < tracks.size(); ++k) {
      benchmark::DoNotOptimize(interpolation.Interpolate(
          tracks.reference.points[k], 1e-3, tracks.views.back().points[k], 1e-3));
    }
  }
}

void Covariance(benchmark::State& state) {
  const testing::TrackScene scene = Scene(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(ComputeCovariance(scene.tracks, scene.truth, 1, 9.21));
  }
}

void Factorization(benchmark::State& state) {
  const testing::TrackScene scene = Scene(state);
  const MotionHypothesis hypothesis{scene.truth.cam_from_reference.back(), {}};
  for (auto _ : state) benchmark::DoNotOptimize(FactorizeTracks(scene.tracks, hypothesis, {}));
}

void Adjustment(benchmark::State& state) {
  const testing::TrackScene scene = Scene(state);
  for (auto _ : state) benchmark::DoNotOptimize(BundleAdjust(scene.tracks, scene.truth, 6));
}

// The whole attempt: motions, factorization, adjustment, decision.
void Decision(benchmark::State& state, bool plane) {
  const testing::TrackScene scene = Scene(state, plane);
  for (auto _ : state) {
    PriorHypotheses prior;
    Rng rng(1);
    benchmark::DoNotOptimize(SelectModel(scene.tracks, {}, prior, rng));
  }
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->ArgNames({"m", "n"});
  for (const int n : {500, 300, 200}) benchmark->Args({3, n});
}
BENCHMARK(LeadingPairOfMatrix)->Apply(Sizes);
BENCHMARK_CAPTURE(Factorize, plain, 0)->Apply(Sizes);
BENCHMARK_CAPTURE(Factorize, reweighted, Rank1Options{}.iterations)->Apply(Sizes);
BENCHMARK(InterpolateFrame)->Apply(Sizes);
BENCHMARK(Covariance)->Apply(Sizes);
BENCHMARK(Factorization)->Apply(Sizes);
BENCHMARK(Adjustment)->Apply(Sizes);
BENCHMARK_CAPTURE(Decision, cloud, false)->Apply(Sizes);
BENCHMARK_CAPTURE(Decision, plane, true)->Apply(Sizes);

}  // namespace
}  // namespace plumbline
