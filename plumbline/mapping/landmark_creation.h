// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/line_options.h"
#include "plumbline/matching/projection_search.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {

// Points and lines made from the depths of one frame, with the features that show them.
struct DepthLandmarks {
  std::vector<std::pair<std::size_t, PointModel>> points;  // the best known depth first
  std::vector<std::pair<std::size_t, LineModel>> lines;
};

// Returns the landmarks that CreateFromDepth makes of the features of a frame that show none yet.
DepthLandmarks LandmarksFromDepth(const RectifiedCamera& camera,
                                  const Frame& frame,
                                  const LandmarkCreationOptions& options);

// Creates points and lines from the depths of one keyframe. They are made of every feature without
// landmark whose depth is known well enough; where the keyframe shows few points with depth, also
// of the best known of the other depths. Each landmark gets one observation.
MapEdit CreateFromDepth(const Map& map,
                        const CameraAndPyramid& imaging,
                        KeyFrameId id,
                        const LandmarkCreationOptions& options);

// Creates points from features without landmark in two keyframes. Features are matched by
// descriptor along the epipolar line and triangulated. A point is kept where parallax, depth and
// the reprojection in both keyframes (with disparity where measured) are good.
MapEdit CreatePointsFromViews(const Map& map,
                              const CameraAndPyramid& imaging,
                              KeyFrameId id,
                              const LandmarkCreationOptions& options);

// Creates lines from line features without landmark in the keyframe and in up to three of its
// closest neighbours (section 3.3). Features are matched by appearance as `lines` says. A line is
// reconstructed from all views, or from two where the views disagree. It is kept where the end
// points of every view lie on the projected line (3 sigmas, TriangulateLine) and the interpretation
// planes meet at a large enough angle.
MapEdit CreateLinesFromViews(const Map& map,
                             const CameraAndPyramid& imaging,
                             KeyFrameId id,
                             const LineOptions& lines = {});

}  // namespace plumbline
