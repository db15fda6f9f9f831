// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_decision.h"

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

}  // namespace plumbline
