// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include <Eigen/Core>

namespace plumbline {

// A point seen by two cameras: its normalized image coordinates (x/z, y/z) in both, and the
// standard deviation of each coordinate (pixels over the focal length).
struct RayMatch {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double sigma_a = 1e-3;
  double sigma_b = 1e-3;
};

// The map x -> scale (x - centre), which gives points mean 0 and mean square 2 (Hartley 1997).
struct Normalization {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double scale = 1;

  Eigen::Vector2d Apply(const Eigen::Vector2d& x) const { return scale * (x - centre); }
  Eigen::Matrix3d Matrix() const {
    Eigen::Matrix3d m = Eigen::Vector3d(scale, scale, 1).asDiagonal();
    m.topRightCorner<2, 1>() = -scale * centre;
    return m;
  }
};

// Returns the map for one side of matches, &RayMatch::a or &RayMatch::b.
inline Normalization NormalizationOf(std::span<const RayMatch> matches,
                                     Eigen::Vector2d RayMatch::*side) {
  Normalization n;
  const double count = static_cast<double>(matches.size());
  for (const RayMatch& m : matches) n.centre += m.*side / count;
  double spread = 0;
  for (const RayMatch& m : matches) spread += (m.*side - n.centre).squaredNorm() / count;
  if (spread > 0) n.scale = std::sqrt(2 / spread);
  return n;
}

}  // namespace plumbline
