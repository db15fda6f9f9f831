// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/matching/projection_search.h"

namespace plumbline {

// Removes the observations that disagree with their landmark at the poses that keyframes have now:
// whose whitened residual (EvaluatePoint; EvaluateLine, left image or right) is longer than 4.
//
// Bundle adjustment judges the observations that are in its window at the time. Keyframes that move
// later, alone or with the whole map, take lines along and leave observations behind that no window
// judges again; lines without depth are in no window at all. So each landmark with an observation
// that disagrees is fitted again, poses held (SolveLocalBa): to all of its observations, and then
// to those that agree, wherever most agree. The others are removed. A landmark that loses
// some and keeps less than three is removed. Landmarks whose observations all agree stay as they
// are, bit by bit.
//
// Returns the change of the map. Cost: one residual for each observation, and a small adjustment
// for each landmark that has an outlier.
MapEdit RemoveOutliers(const Map& map, const CameraAndPyramid& imaging, const LineWeights& weights);

}  // namespace plumbline
