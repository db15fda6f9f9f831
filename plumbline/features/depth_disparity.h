// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/types.h"
#include "plumbline/image/image.h"

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

namespace plumbline {

struct DepthDisparityOptions {
  double min_depth_m = 0.3;
  double max_depth_m = 8;
};

// Returns the disparity fx * baseline / z of each point from a registered depth image; nullopt if
// depth is missing, out of range, or jumps inside the 3x3 neighbourhood.
//
// sigma_z follows the structured-light model a + b (z - 0.4)^2 (Nguyen, Izadi and Lovell, 3DIMPVT
// 2012). The deviation of a disparity is fx * baseline / z^2 * sigma_z, plus the slope of the depth
// across half a pixel, a possible misregistration of depth and colour.
std::vector<std::optional<Disparity>> PointDisparities(const RectifiedCamera& camera,
                                                       const DepthImage& depth,
                                                       const std::vector<PointFeature>& points,
                                                       const DepthDisparityOptions& options);

// Returns the virtual right line of each line from a registered depth image: ends (u - d, v).
//
// Depth is sampled along the line and a little to both sides. Of the two sides the nearer surface
// is used, to which a line on an occluding edge belongs. 1/z is linear along the image of a
// straight 3D line, so that disparity is fitted as a linear function of arc length: first the best
// of all sample pairs, then least squares over its inliers. nullopt if too few samples agree.
std::vector<std::optional<MeasuredSegment>> VirtualRightLines(const RectifiedCamera& camera,
                                                              const DepthImage& depth,
                                                              const std::vector<LineFeature>& lines,
                                                              const DepthDisparityOptions& options);

template <class Visitor>
void VisitFields(Visitor&& visit, DepthDisparityOptions& o) {
  visit("min_depth_m", o.min_depth_m, "nearest depth used [m]", Range{0, 100});
  visit("max_depth_m", o.max_depth_m, "farthest depth used [m]", Range{0.1, 1000});
}

}  // namespace plumbline
