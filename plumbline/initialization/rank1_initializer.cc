// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/rank1_initializer.h"

#include "plumbline/initialization/byte_format.h"

#include <numbers>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr int kDecisionPoints = 200;
constexpr int kMinPoints = 30;  // of a map
// Largest standard deviation of an interpolated place that is used; corners have 0.2 to 1 pixel.
constexpr double kMaxInterpolationPx = 2;

}  // namespace

Rank1Initializer::Rank1Initializer(const ImagingModel& imaging,
                                   const InitializationOptions& options,
                                   std::uint64_t seed)
    : WindowInitializer(imaging.camera, options.matching, options.frames),
      imaging_(imaging),
      options_(options),
      seed_(seed) {
  const double focal = 0.5 * (imaging.camera.fx + imaging.camera.fy);
  WindowFactorizationOptions& factorization = decision_.factorization;
  factorization.factorize = options.factorize;
  factorization.interpolate = options.interpolate;
  factorization.max_interpolation_sigma = kMaxInterpolationPx / focal;
  factorization.min_line_angle = options.min_line_angle_deg * std::numbers::pi / 180;
  factorization.reweighting = options.reweighting;
  decision_.relative_pose.method = options.relative_pose;
}

InitializationResult Rank1Initializer::Attempt() {
  const std::vector<int> frames = window_.Spread(options_.frames);
  const WindowTracks tracks = window_.TracksOf(frames, kDecisionPoints);
  Rng rng(
      seed_, "initialization", static_cast<std::uint64_t>(window_.frame(frames.back()).id.value));
  const WindowDecision decision = DecideWindow(tracks, decision_, memory_, rng);
  InitializationResult result;
  result.wait = decision.wait;
  result.parallax_deg = decision.parallax_deg;
  if (!decision.solution) return result;
  std::vector<InitialView> views{{window_.reference(), Rigid3{}}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    views.push_back({window_.frame(frames[i]), decision.solution->cam_from_reference[i]});
  }
  InitialMap map = BuildStructure(
      imaging_.camera, std::move(views), window_.PointTracks(frames), window_.LineTracks(frames));
  if (!map.points.empty()) ScaleMap(1 / MedianDepth(map), map);
  if (static_cast<int>(map.points.size() + map.lines.size()) < kMinPoints) {
    result.wait = InitializationWait::kInaccurate;
    return result;
  }
  result.map = std::move(map);
  return result;
}

void Rank1Initializer::Save(StateWriter& archive) const { Transfer(archive, *this); }

void Rank1Initializer::Load(StateReader& archive) { Transfer(archive, *this); }

}  // namespace plumbline
