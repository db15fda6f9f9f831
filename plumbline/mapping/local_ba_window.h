// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/mapping/map_problem.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/matching/projection_search.h"

#include <vector>

namespace plumbline {

// Local bundle adjustment around a keyframe, whose camera is the world of the problem.
struct LocalBaWindow : MapProblem {
  std::vector<LineId> lines;  // line of each index in the problem
};

// Returns the window around a keyframe. The keyframe and its covisible keyframes are free, except
// the first one of the map; other keyframes that see the same landmarks are fixed. At least one
// keyframe is fixed, with a single camera two unless the window is the whole map; if need be, the
// oldest of the window. Landmarks need two views. Lines need in addition a large enough angle
// between their interpretation planes, or ends of small uncertainty.
LocalBaWindow MakeLocalBaWindow(const Map& map,
                                const CameraAndPyramid& imaging,
                                KeyFrameId centre,
                                const LineSettings& lines,
                                const LocalBaWindowOptions& options);

// Returns the result as changes of the map: poses, landmarks (lines with new intervals and
// information), and the removal of outlier observations.
MapEdit ToEdit(const Map& map,
               const CameraAndPyramid& imaging,
               const LocalBaWindow& window,
               const BaResult& result);

}  // namespace plumbline
