// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/map/recent_landmarks.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/projection_search.h"

namespace plumbline {

// Removes recent landmarks that the tracker seldom finds at their projection, or that too few
// keyframes show after their probation. Landmarks that passed it leave the list of recent ones.
MapEdit RemoveWeakLandmarks(const Map& map, KeyFrameId newest, RecentLandmarks& young);

// Removes at most one keyframe: the first redundant one around `centre`, in the order of
// covisibility. A keyframe is redundant if three others show nearly all of its landmarks (those
// that only this keyframe shows do not count), points at most an octave coarser. The first
// keyframe, `centre` and the keyframe before it stay.
MapEdit RemoveRedundantKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options);

// Removes at most one keyframe at a revisited place. A smaller share of its landmarks must be shown
// by others (CleanupOptions::revisited_share), but each of these also by a keyframe of another
// visit, more than 20 keyframes before or after. A camera that returns again and again makes
// keyframes each time and finds a landmark in some of them only, so that with
// RemoveRedundantKeyFrames alone their number would grow without end. Landmarks that too few
// keyframes show afterwards are removed, too. Visits the 30 closest keyframes.
MapEdit RemoveRevisitedKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options);

}  // namespace plumbline
