// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Returns two orthonormal directions, as columns, perpendicular to a unit vector t. A change of the
// direction t is written in them: t + basis d, normalized.
inline Eigen::Matrix<double, 3, 2> BasisAcross(const Eigen::Vector3d& direction) {
  Eigen::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = direction.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  basis.col(1) = direction.cross(basis.col(0)).normalized();
  return basis;
}

}  // namespace plumbline
