// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// E = [t]x R: x_b . E x_a = 0 for rays of one point. Zero where the cameras share their centre.
// Chain poses and form E once: a product of essential matrices is not one.
inline Eigen::Matrix3d EssentialMatrix(const Rigid3& b_from_a) {
  return Skew(b_from_a.translation) * b_from_a.rotation.toRotationMatrix();
}

// The same for pixels (x, y, 1) of two rectified images.
Eigen::Matrix3d FundamentalMatrix(const RectifiedCamera& camera, const Rigid3& b_from_a);

// Squared Sampson distance of a match, px^2: the squared distance to the nearest pair of pixels
// that satisfies x_b . F x_a = 0, to first order. Over the variance of a coordinate it is
// chi-square with one degree of freedom. 0 at exact matches; nullopt where it is undefined (both
// pixels epipoles).
std::optional<double> SquaredSampsonDistance(const Eigen::Matrix3d& fundamental,
                                             const Eigen::Vector2d& px_a,
                                             const Eigen::Vector2d& px_b);

// How far two segments can show the same piece of a line: the epipolar lines of the ends of
// `segment_a` cut the line of `segment_b`; overlap of the two pieces there, over the shorter of
// them, in [0, 1].
//
//   min_angle  radians; nullopt where an epipolar line meets segment_b at less, since the cut is
//   then
//              not determined, and where a segment has no length
std::optional<double> EpipolarOverlap(const Eigen::Matrix3d& fundamental,
                                      const Segment2& segment_a,
                                      const Segment2& segment_b,
                                      double min_angle = 0.05);

}  // namespace plumbline
