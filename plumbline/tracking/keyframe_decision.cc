// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_decision.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

// A keyframe is made when a smaller share of the landmarks of the last keyframe than the first
// limit is tracked, and at once when it is smaller than the second: tracking is about to fail then.
constexpr double kMinLandmarkRatio = 0.7;
constexpr double kCriticalRatio = 0.35;
// With one camera the limit is higher, since it needs a second keyframe to triangulate new
// landmarks.
constexpr double kMinMonocularRatio = 0.9;
// Near points fix the translation. A frame that tracks `kMinClose` of them needs no keyframe for
// them; otherwise a keyframe must bring at least `kMinNewClose` new ones.
constexpr int kMinClose = 100;
constexpr int kMinNewClose = 70;

// Number of keyframes that observe a well observed landmark (fewer in a recent map). Differs from
// TrackingOptions::established_views, which defines trusted landmarks, may be 0, and is the same
// with one camera.
constexpr int kWellObserved = 3;
// With one camera a landmark has two views from the beginning. If few landmarks live longer, a
// limit of three views would lose all of them before a keyframe is made.
constexpr int kWellObservedByOne = 2;
// A point counts as near if the deviation of its depth, relative to the depth, is below this: such
// points fix the translation.
constexpr double kCloseDepthSigma = 0.05;

// Counts the landmarks of a keyframe that at least `needed` keyframes show, and how many of these
// the frame shows as well.
template <class LandmarkId>
void CountShared(const std::vector<LandmarkId>& of_keyframe,
                 const std::vector<LandmarkId>& of_frame,
                 const MapSnapshot& snapshot,
                 int needed,
                 KeyFrameSituation& situation) {
  std::vector<LandmarkId> known;
  for (const LandmarkId id : of_keyframe) {
    const auto* landmark = id.valid() ? snapshot.Find(id) : nullptr;
    if (landmark != nullptr && landmark->observation_count >= needed) known.push_back(id);
  }
  std::sort(known.begin(), known.end());
  situation.reference_landmarks += static_cast<int>(known.size());
  situation.shared_landmarks +=
      static_cast<int>(std::count_if(of_frame.begin(), of_frame.end(), [&](LandmarkId id) {
        return std::binary_search(known.begin(), known.end(), id);
      }));
}

}  // namespace

KeyFrameReason DecideKeyFrame(const KeyFrameSituation& situation,
                              const KeyFramePolicyOptions& options) {
  const double usual = situation.share_of_usual;
  const bool needs_close = situation.close_tracked < usual * kMinClose &&
                           situation.close_untracked > usual * kMinNewClose;
  const auto fewer_than = [&](double ratio) {
    return situation.shared_landmarks <
           ratio * situation.share_of_reference * situation.reference_landmarks;
  };
  const double min_ratio = situation.monocular ? kMinMonocularRatio : kMinLandmarkRatio;
  if (fewer_than(kCriticalRatio)) return KeyFrameReason::kAlmostLost;
  if (situation.frames_since_keyframe < options.min_frames) return KeyFrameReason::kNone;
  if (fewer_than(min_ratio)) return KeyFrameReason::kFewLandmarks;
  if (needs_close) return KeyFrameReason::kNeedsClosePoints;
  if (situation.frames_since_keyframe >= options.max_frames) return KeyFrameReason::kLongAgo;
  return KeyFrameReason::kNone;
}

KeyFrameSituation SituationOf(const Frame& frame,
                              const LandmarkMatches& association,
                              const MapSnapshot& snapshot,
                              int frames_since_keyframe,
                              double feature_share,
                              bool monocular) {
  KeyFrameSituation situation;
  situation.frames_since_keyframe = frames_since_keyframe;
  situation.monocular = monocular;
  const Frame& reference = snapshot.reference->frame;
  if (feature_share < 1) {
    const auto features = [](const Frame& f) {
      return static_cast<double>(f.points.size() + f.lines.size());
    };
    situation.share_of_usual = feature_share;
    situation.share_of_reference =
        std::min(1.0, features(frame) / std::max(1.0, features(reference)));
  }
  const int needed = std::min(situation.monocular ? kWellObservedByOne : kWellObserved,
                              static_cast<int>(snapshot.cam_from_world.size()));
  CountShared(reference.points, frame.points, snapshot, needed, situation);
  CountShared(reference.lines, frame.lines, snapshot, needed, situation);
  const auto& disparities = frame.features().point_disparity;
  for (std::size_t i = 0; i < disparities.size(); ++i) {
    if (!disparities[i] || disparities[i]->sigma_px > kCloseDepthSigma * disparities[i]->px) {
      continue;
    }
    const bool tracked = association.matches.point_of_feature[i] >= 0 && frame.points[i].valid();
    ++(tracked ? situation.close_tracked : situation.close_untracked);
  }
  return situation;
}

}  // namespace plumbline
