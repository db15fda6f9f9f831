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

// A keyframe and the feature by which it shows a line.
struct LineViewOf {
  KeyFrameId keyframe;
  std::size_t feature = 0;
};

// Makes a line from at least two keyframes of a map that show it in the left image and, where
// measured, in the right one (TriangulateLine). The line has these observations and the interval
// that the first of them shows; neither id nor creator are set. Returns nullopt where the views do
// not agree, or see the line from too near each other.
std::optional<MapLine> LineFromViews(const Map& map,
                                     const RectifiedCamera& camera,
                                     const std::vector<LineViewOf>& views);

// The same with the tests of the first paper (section 3.3): the ends of every left segment are
// within one pixel of the line, and where there are two keyframes, both ends of the line pass the
// tests of a point as in ORB-SLAM: in front of both cameras, with at least 1.15 degrees between
// their rays.
std::optional<MapLine> CheckedLineFromViews(const Map& map,
                                            const RectifiedCamera& camera,
                                            const std::vector<LineViewOf>& views);

}  // namespace plumbline
