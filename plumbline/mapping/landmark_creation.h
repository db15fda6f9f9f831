// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/line_options.h"
#include "plumbline/association/projection_search.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/options.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {

// Points and lines made from the depths of one frame, with the features that show them.
struct DepthLandmarks {
  std::vector<std::pair<std::size_t, PointModel>> points;  // the best known first
  std::vector<std::pair<std::size_t, LineModel>> lines;
};

// Returns the landmarks that CreateFromDepth makes of the features of a frame that show none yet.
DepthLandmarks LandmarksFromDepth(const RectifiedCamera& camera,
                                  const Frame& frame,
                                  const LandmarkCreationOptions& options);

// Creates points and lines from the depths of one keyframe: of every feature without landmark whose
// depth is known well enough, and, where the keyframe shows few points with depth, of the others
// with the best known depths. Each landmark gets one observation.
MapEdit CreateFromDepth(const Map& map,
                        const ImagingModel& imaging,
                        KeyFrameId id,
                        const LandmarkCreationOptions& options);

// New points from features without landmark in two keyframes: searched along the epipolar line by
// descriptor, triangulated, and kept where parallax, depth and reprojection in both (with disparity
// where measured) are good.
MapEdit CreatePointsFromViews(const Map& map,
                              const ImagingModel& imaging,
                              KeyFrameId id,
                              const LandmarkCreationOptions& options);

// New lines from line features without landmark in the keyframe and in up to three of its closest
// neighbours (section 3.3), matched by their looks as `lines` says: n-view reconstruction, from two
// views where the views disagree, kept where the end points of every view lie on the projected line
// (3 sigmas, TriangulateLine) and the interpretation planes meet at a large enough angle.
MapEdit CreateLinesFromViews(const Map& map,
                             const ImagingModel& imaging,
                             KeyFrameId id,
                             const LineOptions& lines = {});

}  // namespace plumbline
