// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/keyframe_decision.h"
#include "plumbline/tracking/landmark_matches.h"

namespace plumbline {

// Returns what the decision about a keyframe depends on for a frame that was tracked against a
// snapshot: how much the frame shows of what the snapshot's keyframe shows, and how many near
// points it has.
//
//   association    the matches that the frame was tracked by
//   feature_share  share of the usual number of features that the frame was measured with
//   monocular      no depth is measured
KeyFrameSituation SituationOf(const Frame& frame,
                              const LandmarkMatches& association,
                              const MapSnapshot& snapshot,
                              int frames_since_keyframe,
                              double feature_share,
                              bool monocular);

}  // namespace plumbline
