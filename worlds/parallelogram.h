// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// A flat piece of a surface: the points origin + a side_u + b side_v, a and b in [0, 1]. Metres.
struct Parallelogram {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d side_u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d side_v = Eigen::Vector3d::UnitY();

  Eigen::Vector3d PointAt(double a, double b) const { return origin + a * side_u + b * side_v; }
  Eigen::AlignedBox3d Bounds() const;
};

// Returns the distance [metres] of a point from the parallelogram: that of its foot in the plane if
// the foot is inside, otherwise that of the nearest side. Also right for sides that are parallel or
// of no length.
double Distance(const Parallelogram& parallelogram, const Eigen::Vector3d& point);

}  // namespace plumbline
