// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/line_options.h"
#include "plumbline/matching/projection_search.h"

namespace plumbline {

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
MapEdit RemoveOutliers(const Map& map, const CameraAndPyramid& imaging, const LineOptions& lines);

}  // namespace plumbline
