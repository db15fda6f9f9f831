// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/covariance.h"

#include "plumbline/geometry/symmetric_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumbline {

double LargestSigma(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(0.0, EigenvaluesOf<3>(covariance)(2)));
}

namespace {

Matrix6d MappedSymmetrically(const Matrix6d& J, const Matrix6d& covariance) {
  const Matrix6d mapped = J * covariance * J.transpose();
  return 0.5 * (mapped + mapped.transpose());
}

}  // namespace

Matrix6d PoseCovarianceInWorld(const Rigid3& cam_from_world, const Matrix6d& of_left_perturbation) {
  // exp([w, v]) T has its centre at c - R^T v and the rotation R^T Exp(-w) = Exp(-R^T w) R^T.
  const Eigen::Matrix3d world_from_camera = cam_from_world.rotation.conjugate().toRotationMatrix();
  Matrix6d J = Matrix6d::Zero();
  J.topRightCorner<3, 3>() = -world_from_camera;
  J.bottomLeftCorner<3, 3>() = -world_from_camera;
  return MappedSymmetrically(J, of_left_perturbation);
}

Matrix6d MovedPoseCovariance(const Matrix6d& covariance,
                             const Eigen::Quaterniond& other_from_world,
                             const Eigen::Vector3d& lever) {
  const Eigen::Matrix3d turn = other_from_world.toRotationMatrix();
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = J.bottomRightCorner<3, 3>() = turn;
  J.topRightCorner<3, 3>() = -turn * Skew(lever);  // w x lever
  return MappedSymmetrically(J, covariance);
}

}  // namespace plumbline
