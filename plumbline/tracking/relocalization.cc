// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/relocalization.h"

#include "plumbline/map/snapshot.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace plumbline {
namespace {

constexpr std::size_t kCompared = 150;  // of the frame's strongest points, and lines
constexpr std::size_t kTried = 6;       // of the keyframes that look most alike
constexpr int kMinAlike = 10;           // partners without which a keyframe is not tried
constexpr int kMaxDistance = 50;        // of descriptors of partners: Hamming, of 256 bits ...
constexpr double kRatio = 0.85;         // ... and against the second best
// Another place that has this share of the inliers leaves it open which of the two it is.
constexpr double kRival = 0.7;

// Descriptors of the strongest features, strongest first.
template <class Feature>
std::vector<Descriptor> Strongest(const std::vector<Feature>& features) {
  std::vector<std::size_t> order(features.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return features[a].response > features[b].response;
  });
  if (order.size() > kCompared) order.resize(kCompared);
  std::vector<Descriptor> descriptors;
  for (const std::size_t i : order) descriptors.push_back(features[i].descriptor);
  return descriptors;
}

// Descriptors of the features that show a landmark.
template <class Feature, class LandmarkId>
std::vector<Descriptor> OfLandmarks(const std::vector<Feature>& features,
                                    const std::vector<LandmarkId>& landmarks) {
  std::vector<Descriptor> descriptors;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (landmarks[i].valid()) descriptors.push_back(features[i].descriptor);
  }
  return descriptors;
}

// How many have one partner that is clearly nearer than all others.
int CountPartners(const std::vector<Descriptor>& of_frame,
                  const std::vector<Descriptor>& of_keyframe) {
  int count = 0;
  for (const Descriptor& descriptor : of_frame) {
    int best = 257;
    int second = 257;
    for (const Descriptor& other : of_keyframe) {
      const int distance = HammingDistance(descriptor, other);
      second = std::min(second, std::max(distance, best));
      best = std::min(best, distance);
    }
    count += best <= kMaxDistance && best < kRatio * second;
  }
  return count;
}

// Every n-th keyframe, so that there are at most `most`; another attempt takes others.
std::vector<const KeyFrame*> Spread(const Map& map, int most, int attempt) {
  const std::size_t count = map.keyframes().size();
  const std::size_t step =
      (count + static_cast<std::size_t>(most) - 1) / static_cast<std::size_t>(most);
  std::vector<const KeyFrame*> spread;
  if (step == 0) return spread;
  std::size_t index = static_cast<std::size_t>(attempt) % step;
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (index++ % step == 0) spread.push_back(&keyframe);
  }
  return spread;
}

// Whether two poses cannot be the same within what tracking can mend.
bool Apart(const Relocalized& a, const Relocalized& b, double scene_depth) {
  constexpr double kDegree = 3.14159265358979 / 180;
  constexpr double kAngle = 5 * kDegree;
  constexpr double kDistance = 0.1;  // of the scene's depth
  const Vector6d motion = LogSe3(a.frame.cam_from_world * Inverse(b.frame.cam_from_world));
  return motion.head<3>().norm() > kAngle || motion.tail<3>().norm() > kDistance * scene_depth;
}

}  // namespace

Relocalizer::Relocalizer(const ImagingModel& imaging,
                         const TrackingOptions& tracking,
                         const LineOptions& lines,
                         const CuttingOptions& cutting,
                         const RelocalizationOptions& options)
    : options_(options), search_(imaging, tracking, lines, cutting) {}

std::vector<KeyFrameId> Relocalizer::MostAlike(const Map& map,
                                               const Frame& frame,
                                               int attempt) const {
  const std::vector<Descriptor> points = Strongest(frame.features().points);
  const std::vector<Descriptor> lines = Strongest(frame.features().lines);
  std::vector<std::pair<int, KeyFrameId>> scores;
  for (const KeyFrame* keyframe : Spread(map, options_.max_keyframes, attempt)) {
    const Frame& other = keyframe->frame;
    const int partners = CountPartners(points, OfLandmarks(other.features().points, other.points)) +
                         CountPartners(lines, OfLandmarks(other.features().lines, other.lines));
    if (partners >= kMinAlike) scores.emplace_back(-partners, keyframe->id);
  }
  std::sort(scores.begin(), scores.end());
  if (scores.size() > kTried) scores.resize(kTried);
  std::vector<KeyFrameId> ids;
  for (const auto& [score, id] : scores) ids.push_back(id);
  return ids;
}

std::optional<Relocalized> Relocalizer::FindBeside(const Map& map,
                                                   const Frame& frame,
                                                   KeyFrameId id) const {
  const auto snapshot = TakeSnapshot(map, id);
  LastFrame keyframe;  // stands in for a frame before, of which only the place is known
  keyframe.frame.cam_from_world = map.PoseOf(id);
  FrameAssociation found;
  FrameCounts counts;
  const auto first = search_.FromAppearance(frame, keyframe, *snapshot, found, counts);
  if (!first) return std::nullopt;
  PoseAttempt attempt =
      search_.WithLocalMap(frame, *first, {first->cam_from_world}, *snapshot, found);
  if (attempt.pose.Inliers() < options_.min_inliers || !search_.Accepted(attempt.pose) ||
      !search_.Agreed(attempt.pose, attempt.counts)) {
    return std::nullopt;
  }
  Relocalized result{frame, std::move(attempt.association), id, attempt.counts};
  result.frame.cam_from_world = attempt.pose.cam_from_world;
  result.counts.inlier_points = attempt.pose.inlier_points;
  result.counts.inlier_lines = attempt.pose.inlier_lines;
  result.scene_depth = attempt.pose.scene_depth;
  return result;
}

std::optional<Relocalized> Relocalizer::Find(const Map& map,
                                             const Frame& frame,
                                             int attempt) const {
  Frame unplaced = frame;
  unplaced.indexed = WithCorrection(frame.indexed, map.stereo_correction());
  std::vector<Relocalized> places;
  for (const KeyFrameId id : MostAlike(map, unplaced, attempt)) {
    if (auto place = FindBeside(map, unplaced, id)) places.push_back(std::move(*place));
  }
  if (places.empty()) return std::nullopt;
  auto best = std::max_element(places.begin(), places.end(), [](const auto& a, const auto& b) {
    return a.Inliers() < b.Inliers();
  });
  for (const Relocalized& other : places) {
    if (other.Inliers() >= kRival * best->Inliers() && Apart(*best, other, best->scene_depth)) {
      return std::nullopt;
    }
  }
  return std::move(*best);
}

}  // namespace plumbline
