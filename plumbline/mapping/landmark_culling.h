// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/landmarks.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/matching/projection_search.h"

namespace plumbline {

// Removes recent landmarks that the tracker seldom finds at their projection, or that too few
// keyframes show after their probation. Landmarks that passed it leave the list of recent ones.
MapEdit RemoveWeakLandmarks(const Map& map, KeyFrameId newest, LandmarkIds& young);

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

// Removes the outlier observations at the current poses of the keyframes: those whose whitened
// residual (EvaluatePoint; EvaluateLine, left image or right) is longer than 4.
//
// Bundle adjustment classifies only the observations in its window. Keyframes that move later,
// alone or with the whole map, move lines and leave outliers that no later window classifies; lines
// without depth are in no window at all. So each landmark with an outlier is fitted again with
// fixed poses (SolveLocalBa): to all of its observations, and then to the inliers, wherever most
// agree. The others are removed. A landmark that loses some and keeps less than three is removed.
// Landmarks without outliers are unchanged, bit by bit. Lines that keep
// their ends (LineMethod::keeps_ends) keep them here: they move only as far as the line does.
//
// Returns the change of the map. Cost: one residual for each observation, and a small adjustment
// for each landmark that has an outlier.
MapEdit RemoveOutliers(const Map& map, const CameraAndPyramid& imaging, const LineSettings& lines);

}  // namespace plumbline
