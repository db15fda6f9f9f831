// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/types.h"
#include "plumbline/image/image.h"

#include <optional>
#include <vector>

namespace plumbline {

struct DepthDisparityOptions {
  double min_depth_m = 0.3;
  double max_depth_m = 8;
  double depth_sigma_a = 0.0012;  // sigma_z = a + b (z - 0.4)^2, metres
  double depth_sigma_b = 0.0019;
  double max_relative_step = 0.05;  // spread of depths around a point that counts as an edge
  double pixel_sigma_px =
      0.5;                  // registration of depth to colour, in disparity at an edge-free spot
  int line_samples = 32;    // samples along a line
  double line_side_px = 2;  // and so far to either side of it
  double min_line_inliers = 0.6;  // share of the samples that must lie on one straight 3D line
};

// Disparity fx * baseline / z of each point from a registered depth image, nullopt where depth is
// missing, out of range, or jumps inside the 3x3 neighbourhood.
//
// sigma_z follows the structured-light model a + b (z - 0.4)^2 (Nguyen, Izadi and Lovell, 3DIMPVT
// 2012), and sigma_disparity = fx * baseline / z^2 * sigma_z, plus the slope of the depth across
// one `pixel_sigma_px`.
std::vector<std::optional<Disparity>> PointDisparities(const RectifiedCamera& camera,
                                                       const DepthImage& depth,
                                                       const std::vector<PointFeature>& points,
                                                       const DepthDisparityOptions& options);

// Virtual right line of each line from a registered depth image: ends (u - d, v).
//
// Depth is sampled along the line and a little to both sides; of the two sides the nearer surface
// is taken, since a line on an occluding edge belongs to it. 1/z is linear along the image of a
// straight 3D line, so a line is fitted to disparity over arc length by the best of all sample
// pairs, then by least squares over its inliers. nullopt when too few samples agree.
std::vector<std::optional<RightLine>> VirtualRightLines(const RectifiedCamera& camera,
                                                        const DepthImage& depth,
                                                        const std::vector<LineFeature>& lines,
                                                        const DepthDisparityOptions& options);

template <class Visitor>
void VisitFields(Visitor&& visit, DepthDisparityOptions& o) {
  visit("min_depth_m", o.min_depth_m, "nearest depth used [m]", Range{0, 100});
  visit("max_depth_m", o.max_depth_m, "farthest depth used [m]", Range{0.1, 1000});
  visit("depth_sigma_a", o.depth_sigma_a, "constant part of the depth noise [m]", Range{1e-6, 1});
  visit("depth_sigma_b", o.depth_sigma_b, "quadratic part of the depth noise [1/m]", Range{0, 1});
  visit("max_relative_step",
        o.max_relative_step,
        "relative depth jump that counts as an edge",
        Range{0.001, 1});
  visit(
      "pixel_sigma_px", o.pixel_sigma_px, "misregistration of depth and colour [px]", Range{0, 10});
  visit("line_samples", o.line_samples, "depth samples along a line", Range{4, 1000});
  visit("line_side_px", o.line_side_px, "offset of the side samples of a line [px]", Range{0, 20});
  visit(
      "min_line_inliers", o.min_line_inliers, "share of samples on a straight line", Range{0.1, 1});
}

}  // namespace plumbline
