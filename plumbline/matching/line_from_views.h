// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/landmarks.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

class Map;
struct LineInterval;

// An observation of a line: keyframe and feature.
struct LineViewOf {
  KeyFrameId keyframe;
  std::size_t feature = 0;
};

// Triangulates a line from at least two keyframes of a map that show it in the left image and, if
// measured, in the right one (TriangulateLine). The line has these observations and the interval of
// the first of them; neither id nor creator are set. Returns nullopt if the views are inconsistent
// or too close to each other.
std::optional<MapLine> LineFromViews(const Map& map,
                                     const RectifiedCamera& camera,
                                     const std::vector<LineViewOf>& views);

// As LineFromViews, with the tests of the first paper (section 3.3): the ends of every left segment
// are within one pixel of the line, and for two keyframes, both ends of the line pass the tests of
// a point as in ORB-SLAM: in front of both cameras, with at least 1.15 degrees between their rays.
std::optional<MapLine> CheckedLineFromViews(const Map& map,
                                            const RectifiedCamera& camera,
                                            const std::vector<LineViewOf>& views);

// Makes a map line of a piece of a line that views show, with what follows from them: observations,
// information, descriptor and viewing direction. Neither id nor creator are set.
MapLine MapLineFrom(const Map& map,
                    const RectifiedCamera& camera,
                    const std::vector<LineViewOf>& views,
                    const PluckerLine& line,
                    const LineInterval& interval);

}  // namespace plumbline
