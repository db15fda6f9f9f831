// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/keyframe_decision.h"
#include "plumbline/tracking/landmark_matches.h"

namespace plumbline {

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
