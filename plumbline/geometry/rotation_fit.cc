// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/rotation_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace plumbline {

RotationFit FitRotation(const Eigen::Matrix3d& correlation) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  return {svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose(),
          svd.singularValues().cwiseProduct(sign)};
}

}  // namespace plumbline
