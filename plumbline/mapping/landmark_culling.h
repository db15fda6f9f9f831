// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/map/recent_landmarks.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/projection_search.h"

namespace plumbline {

// Removes young landmarks that the tracker seldom finds where they should be, or that too few
// keyframes show after their trial. Landmarks that passed the trial leave the list of young ones.
MapEdit RemoveWeakLandmarks(const Map& map, KeyFrameId newest, RecentLandmarks& young);

// Removes at most one keyframe: the first redundant one of those around `centre`, looked at in the
// order of covisibility. A keyframe is redundant if three others show nearly all of its landmarks
// (those that only this keyframe shows do not count), points at most an octave coarser. The first
// keyframe, `centre` and the keyframe before it stay.
MapEdit RemoveRedundantKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options);

// Removes at most one keyframe at a place that is seen again. A smaller share of its landmarks must
// be shown by others (CleanupOptions::revisited_share), but each of these also by a keyframe of
// another visit, more than 20 keyframes before or after. A camera that comes again and again makes
// keyframes each time and finds a landmark in some of them only, so that RemoveRedundantKeyFrames
// alone would let their number grow without end. Landmarks that too few keyframes show afterwards
// are removed, too. Looks at the 30 closest keyframes.
MapEdit RemoveRevisitedKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options);

}  // namespace plumbline
