// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

#include <array>
#include <type_traits>

namespace plumbline {

// How soon and how late keyframes follow each other.
struct KeyFramePolicyOptions {
  int max_frames = 20;  // a keyframe is made at the latest after so many frames
  int min_frames = 2;   // no keyframe is made sooner, unless tracking is about to fail
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

// Why a frame becomes a keyframe.
enum class KeyFrameReason {
  kNone,              // it does not
  kFewLandmarks,      // it shows too few landmarks of the last keyframe
  kAlmostLost,        // it shows so few of them that tracking is about to fail
  kNeedsClosePoints,  // it tracks too few near points, and sees near points that the map lacks
  kLongAgo            // max_frames have passed since the last keyframe
};

// What the decision about a keyframe depends on: how the frame that was just tracked compares with
// the last keyframe.
struct KeyFrameSituation {
  int frames_since_keyframe = 0;
  // Number of the `reference_landmarks` that the frame shows as well.
  int shared_landmarks = 0;
  // Well observed points and lines that the last keyframe shows.
  int reference_landmarks = 0;
  int close_tracked = 0;    // points with good disparity that show a map point
  int close_untracked = 0;  // points with good disparity that show no map point
  bool monocular = false;   // no depth is measured
  // How many features the frame was measured with, relative to the usual number and to that of the
  // last keyframe. Both are less than 1 only where a live run sheds features; the counts above are
  // then compared with limits that are lower by the same share.
  double share_of_usual = 1;
  double share_of_reference = 1;
};

// Decides whether a tracked frame becomes a keyframe, and why. The decision depends only on what
// the camera sees, not on how busy the machine is.
KeyFrameReason DecideKeyFrame(const KeyFrameSituation& situation,
                              const KeyFramePolicyOptions& options);

}  // namespace plumbline
