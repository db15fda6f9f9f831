// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Returns two directions of unit length, as columns, at right angles to a unit vector t and to each
// other. A change of the direction t is written in them: t + basis d, scaled to length 1.
inline Eigen::Matrix<double, 3, 2> BasisAcross(const Eigen::Vector3d& direction) {
  Eigen::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = direction.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  basis.col(1) = direction.cross(basis.col(0)).normalized();
  return basis;
}

}  // namespace plumbline
