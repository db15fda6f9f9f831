// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/two_view_images_initializer.h"

#include "plumbline/initialization/byte_format.h"
#include "plumbline/solvers/ray_match.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// All points that the reference and the newest frame show.
std::vector<RayMatch> MatchesOf(const WindowTracks& tracks) {
  std::vector<RayMatch> matches;
  const TrackedPoints& newest = tracks.views.front();
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    matches.push_back({tracks.reference.points[k],
                       newest.points[k],
                       tracks.reference.sigmas[k],
                       newest.sigmas[k]});
  }
  return matches;
}

}  // namespace

InitializationResult TwoViewImagesInitializer::Attempt() {
  const WindowTracks tracks =
      window_.TracksOf({window_.size() - 1}, std::numeric_limits<int>::max());
  const InitializationFrame& newest = window_.frame(window_.size() - 1);
  Rng rng(seed_, "two_view", static_cast<std::uint64_t>(newest.id.value));
  const TwoViewSolution solution = SolveTwoViews(MatchesOf(tracks), rng);
  InitializationResult result;
  result.parallax_deg = solution.parallax_deg;
  result.wait = solution.wait;
  if (result.wait != InitializationWait::kNone) return result;
  result.map = BuildMap(tracks, solution);
  if (!result.map) result.wait = InitializationWait::kInaccurate;
  return result;
}

std::optional<InitialMap> TwoViewImagesInitializer::BuildMap(
    const WindowTracks& tracks, const TwoViewSolution& solution) const {
  const int newest = window_.size() - 1;
  std::vector<bool> is_good(window_.reference().indexed->features.points.size(), false);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    is_good[static_cast<std::size_t>(tracks.features[k])] = solution.is_good[k];
  }
  std::vector<FeatureTrack> points = window_.PointTracks({newest});
  std::erase_if(points, [&](const FeatureTrack& track) {
    return !is_good[static_cast<std::size_t>(track.front().feature)];
  });
  return BuildTwoViewMap(camera_,
                         {window_.reference(), window_.frame(newest)},
                         solution.b_from_a,
                         points,
                         window_.LineTracks({newest}));
}

void TwoViewImagesInitializer::Save(StateWriter& archive) const { Transfer(archive, *this); }

void TwoViewImagesInitializer::Load(StateReader& archive) { Transfer(archive, *this); }

}  // namespace plumbline
