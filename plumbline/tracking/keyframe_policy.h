// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

#include <array>
#include <type_traits>

namespace plumbline {

struct KeyFramePolicyOptions {
  int max_frames = 20;  // a keyframe at the latest after so many frames
  int min_frames = 2;   // and never sooner than this, unless tracking is about to fail
};

template <class Visitor>
void VisitFields(Visitor&& visit, KeyFramePolicyOptions& o) {
  visit(
      "max_frames", o.max_frames, "a keyframe at the latest after so many frames", Range{1, 10000});
  visit("min_frames",
        o.min_frames,
        "frames after a keyframe until the next may come, unless tracking is about to fail; 1: the "
        "very next",
        Range{1, 1000});
}

constexpr auto FixedOptions(std::type_identity<KeyFramePolicyOptions>) {
  return std::array{FixedOption{"min_landmark_ratio", "0.7"},
                    FixedOption{"monocular_landmark_ratio", "0.9"},
                    FixedOption{"critical_ratio", "0.35"},
                    FixedOption{"min_close", "100"},
                    FixedOption{"min_new_close", "70"}};
}

enum class KeyFrameReason { kNone, kFewLandmarks, kAlmostLost, kNeedsClosePoints, kLongAgo };

// What the decision depends on, of the frame just tracked.
struct KeyFrameSituation {
  int frames_since_keyframe = 0;
  int shared_landmarks = 0;     // of the following, those that it shows, too
  int reference_landmarks = 0;  // well observed points and lines that the last keyframe shows
  int close_tracked = 0;        // points with good disparity that show a map point
  int close_untracked = 0;      // and that show none
  bool monocular = false;       // no depth is measured
  // Features that the frame was measured with: of those that it would be measured with usually, and
  // of those of the last keyframe. Less than 1 only where a live run sheds features; what is
  // counted above is then held against as much less.
  double share_of_usual = 1;
  double share_of_reference = 1;
};

// Whether a tracked frame should become a keyframe, and why. A pure function, and one of what the
// camera sees alone: how busy the machine is does not count.
KeyFrameReason DecideKeyFrame(const KeyFrameSituation& situation,
                              const KeyFramePolicyOptions& options);

}  // namespace plumbline
