// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/relocalization.h"

#include "plumbline/base/units.h"
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr std::size_t kTried = 6;  // most candidates that are tried
// Most of the tried candidates that may be close neighbours of each other.
constexpr int kOfOnePlace = 2;
// Number of close neighbours of a keyframe: those that share most landmarks with it.
constexpr int kCloseNeighbours = 10;
// If another place has at least this share of the inliers, both are rejected.
constexpr double kRival = 0.7;
// Points and lines: by chance fewer agree with a wrong pose.
constexpr int kMinInliers = 30;

// Chooses the candidates to try, best first, few of them near each other: a failure from one
// keyframe usually recurs from its neighbours, and a success needs no second attempt.
std::vector<PlaceToTry> OfDifferentPlaces(std::span<const PlaceToTry> candidates) {
  std::vector<PlaceToTry> tried;
  std::map<KeyFrameId, int> neighbours;  // how many of the tried keyframes have it as a neighbour
  for (const PlaceToTry& place : candidates) {
    const auto& [map, id] = place;
    if (tried.size() == kTried) break;
    if (map->Find(id) == nullptr || neighbours[id] >= kOfOnePlace) continue;
    tried.push_back(place);
    for (const auto& near : ClosestCovisible(*map, id, kCloseNeighbours)) ++neighbours[near.id];
  }
  return tried;
}

// A frame that was found in one of the maps.
struct PlaceFound {
  const Map* map = nullptr;
  Relocalized frame;
};

// Returns true if two poses are too far apart for tracking to get from one to the other.
bool Apart(const PlaceFound& one, const PlaceFound& other) {
  if (one.map != other.map) return true;
  const Relocalized& a = one.frame;
  const Relocalized& b = other.frame;
  constexpr double kAngle = 5 * kDegree;
  constexpr double kDistance = 0.1;  // relative to the depth of the scene
  const Vector6d motion = LogSe3(a.frame.cam_from_world * Inverse(b.frame.cam_from_world));
  return motion.head<3>().norm() > kAngle || motion.tail<3>().norm() > kDistance * a.scene_depth;
}

}  // namespace

Relocalizer::Relocalizer(const CameraAndPyramid& imaging,
                         const TrackingOptions& tracking,
                         const PoseEstimator& estimator)
    : search_(imaging, tracking, estimator) {}

std::optional<Relocalized> Relocalizer::Find(const Frame& frame,
                                             const MapSnapshot& snapshot) const {
  Frame corrected = frame;
  corrected.indexed = WithCorrection(frame.indexed, snapshot.correction);
  return FindCorrected(corrected, snapshot);
}

std::optional<Relocalized> Relocalizer::FindCorrected(const Frame& frame,
                                                      const MapSnapshot& snapshot) const {
  // The keyframe stands in for the last frame.
  const LastFrame keyframe{snapshot.reference->frame, {}};
  LandmarkMatches found;
  FrameCounts counts;
  const auto first = search_.FromAppearance(frame, keyframe, snapshot, found, counts);
  if (!first) return std::nullopt;
  PoseAttempt attempt =
      search_.WithLocalMap(frame, *first, {first->cam_from_world}, snapshot, found, {});
  if (attempt.pose.Inliers() < kMinInliers || !search_.Accepted(attempt.pose) ||
      !search_.Agreed(attempt.pose, attempt.counts)) {
    return std::nullopt;
  }
  Relocalized result{frame, std::move(attempt.association), snapshot.centre, attempt.counts};
  result.frame.cam_from_world = attempt.pose.cam_from_world;
  result.counts.inlier_points = attempt.pose.inlier_points;
  result.counts.inlier_lines = attempt.pose.inlier_lines;
  result.scene_depth = attempt.pose.scene_depth;
  return result;
}

std::optional<Relocalized> Relocalizer::Find(const Frame& frame,
                                             std::span<const PlaceToTry> candidates) const {
  std::vector<PlaceFound> places;
  Frame corrected = frame;  // corrected as in the map of the place
  for (const PlaceToTry& place : OfDifferentPlaces(candidates)) {
    const FeatureCorrection& correction = place.map->correction();
    if (!(corrected.indexed->correction == correction)) {
      corrected.indexed = WithCorrection(frame.indexed, correction);
    }
    const auto snapshot = TakeSnapshot(*place.map, place.keyframe);
    auto found = FindCorrected(corrected, *snapshot);
    if (found) places.push_back({place.map, *std::move(found)});
  }
  if (places.empty()) return std::nullopt;
  const auto best =
      std::max_element(places.begin(), places.end(), [](const auto& a, const auto& b) {
        return a.frame.Inliers() < b.frame.Inliers();
      });
  for (const PlaceFound& other : places) {
    if (other.frame.Inliers() >= kRival * best->frame.Inliers() && Apart(*best, other)) {
      return std::nullopt;
    }
  }
  return std::move(best->frame);
}

}  // namespace plumbline
