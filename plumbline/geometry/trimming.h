// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// An interval of a PluckerLine, from parameter start to parameter end: Foot() + t * direction.
struct LineInterval {
  double start = 0;
  double end = 0;
};

// Returns the parameter of the point of a 3D line that corresponds to a pixel near its projection.
//
// Intersects the line with the plane through the camera centre and the image line perpendicular to
// the projected line at the foot of the pixel (first paper, eq. 26-30). The perpendicular image
// line is (l2, -l1, l1 y - l2 x) through the foot (x, y), in place of eq. 28-29, which fail for
// horizontal and vertical lines.
//
//   cam_from_world  pose of the camera; line_in_world in the same world
//   px              rectified pixel
//   returns         parameter along line_in_world
//   fails           nullopt: the point is behind the camera, or the line goes through the camera
//                   centre or runs parallel to the viewing plane
std::optional<double> TrimmedParameter(const RectifiedCamera& camera,
                                       const Rigid3& cam_from_world,
                                       const PluckerLine& line_in_world,
                                       const Eigen::Vector2d& px);

// Returns the parameters of both ends of an observed segment. end < start if the segment runs
// against the line's direction.
std::optional<LineInterval> TrimToSegment(const RectifiedCamera& camera,
                                          const Rigid3& cam_from_world,
                                          const PluckerLine& line_in_world,
                                          const Segment2& segment);

// Returns the segment between the two points of an interval.
inline Segment3 SegmentOf(const PluckerLine& line, const LineInterval& interval) {
  return {line.PointAt(interval.start), line.PointAt(interval.end)};
}

}  // namespace plumbline
