// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_policy.h"

namespace plumbline {
namespace {

// A keyframe comes when a smaller share of the landmarks that the last one shows is tracked, and at
// once where tracking is about to fail.
constexpr double kMinLandmarkRatio = 0.7;
constexpr double kCriticalRatio = 0.35;
// One camera needs a second keyframe to know where new landmarks are.
constexpr double kMinMonocularRatio = 0.9;
// Near points fix the translation: so many are enough, and so many a keyframe must bring.
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
