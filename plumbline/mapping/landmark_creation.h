// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/matching/projection_search.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {

// Points and lines made from the depths of one frame, with their features.
struct DepthLandmarks {
  std::vector<std::pair<std::size_t, PointModel>> points;  // by increasing uncertainty of depth
  std::vector<std::pair<std::size_t, LineModel>> lines;
};

// Returns the landmarks that CreateFromDepth makes from the unmatched features of a frame.
DepthLandmarks LandmarksFromDepth(const RectifiedCamera& camera,
                                  const Frame& frame,
                                  const LandmarkCreationOptions& options);

// Creates points and lines from the depths of one keyframe: one of every unmatched feature whose
// depth is certain enough; if the keyframe shows few points with depth, also from the most certain
// of the other depths. Each landmark gets one observation.
MapEdit CreateFromDepth(const Map& map,
                        const CameraAndPyramid& imaging,
                        KeyFrameId id,
                        const LandmarkCreationOptions& options);

// Creates points from unmatched features in two keyframes. Features are matched by descriptor along
// the epipolar line and triangulated. A point is kept if parallax, depth and the reprojection in
// both keyframes (with disparity if measured) are good.
MapEdit CreatePointsFromViews(const Map& map,
                              const CameraAndPyramid& imaging,
                              KeyFrameId id,
                              const LandmarkCreationOptions& options);

// Creates lines from unmatched line features in the keyframe and in up to three of its closest
// neighbours (section 3.3). Features are matched by descriptors according to `lines`. A line is
// reconstructed from all views, or from two if the views are inconsistent. It is kept if the end
// points of every view lie on the projected line (3 sigmas, TriangulateLine) and the interpretation
// planes meet at a large enough angle.
MapEdit CreateLinesFromViews(const Map& map,
                             const CameraAndPyramid& imaging,
                             KeyFrameId id,
                             const LineSettings& lines = {});

}  // namespace plumbline
