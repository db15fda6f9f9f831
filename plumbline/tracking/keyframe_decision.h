// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/landmark_matches.h"
#include "plumbline/tracking/options.h"

#include <array>
#include <type_traits>

namespace plumbline {

// Reason for a keyframe.
enum class KeyFrameReason {
  kNone,          // no keyframe
  kFewLandmarks,  // the frame shows too few landmarks of the last keyframe
  kAlmostLost,    // even fewer: tracking is about to fail
  // too few near points are tracked, and near points are seen that the map lacks
  kNeedsClosePoints,
  kLongAgo  // max_frames have passed since the last keyframe
};

// Input of the keyframe decision: the last tracked frame compared with the last keyframe.
struct KeyFrameSituation {
  int frames_since_keyframe = 0;
  // Number of the `reference_landmarks` visible in the frame as well.
  int shared_landmarks = 0;
  // Well observed points and lines of the last keyframe.
  int reference_landmarks = 0;
  int close_tracked = 0;    // points with good disparity matched with a map point
  int close_untracked = 0;  // points with good disparity without a map point
  bool monocular = false;   // true if no depth is measured
  // Number of extracted features relative to the usual number and to that of the last keyframe.
  // Both are less than 1 only if a live run sheds features; the limits of the counts above are then
  // lower by the same share.
  double share_of_usual = 1;
  double share_of_reference = 1;
};

// Decides whether a tracked frame becomes a keyframe, and why. The decision depends only on the
// camera's measurements, not on the load of the machine.
KeyFrameReason DecideKeyFrame(const KeyFrameSituation& situation,
                              const KeyFramePolicyOptions& options);

// Returns the input of the keyframe decision for a frame tracked against a snapshot: its share of
// the landmarks of the snapshot's keyframe, and its number of near points.
//
//   association    matches of the frame
//   feature_share  share of the usual number of features that was extracted
//   monocular      true if no depth is measured
KeyFrameSituation SituationOf(const Frame& frame,
                              const LandmarkMatches& association,
                              const MapSnapshot& snapshot,
                              int frames_since_keyframe,
                              double feature_share,
                              bool monocular);

}  // namespace plumbline
