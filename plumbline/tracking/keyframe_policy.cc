// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_policy.h"

namespace plumbline {

KeyFrameReason DecideKeyFrame(const KeyFrameSituation& situation,
                              const KeyFramePolicyOptions& options) {
  const double usual = situation.share_of_usual;
  const bool needs_close = situation.close_tracked < usual * options.min_close &&
                           situation.close_untracked > usual * options.min_new_close;
  const auto fewer_than = [&](double ratio) {
    return situation.shared_landmarks <
           ratio * situation.share_of_reference * situation.reference_landmarks;
  };
  const double min_ratio =
      situation.monocular ? options.monocular_landmark_ratio : options.min_landmark_ratio;
  if (fewer_than(options.critical_ratio)) return KeyFrameReason::kAlmostLost;
  if (situation.frames_since_keyframe < options.min_frames) return KeyFrameReason::kNone;
  if (fewer_than(min_ratio)) return KeyFrameReason::kFewLandmarks;
  if (needs_close) return KeyFrameReason::kNeedsClosePoints;
  if (situation.frames_since_keyframe >= options.max_frames) return KeyFrameReason::kLongAgo;
  return KeyFrameReason::kNone;
}

}  // namespace plumbline
