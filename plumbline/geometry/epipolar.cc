// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/epipolar.h"

namespace plumbline {

Eigen::Matrix3d FundamentalMatrix(const RectifiedCamera& camera, const Rigid3& b_from_a) {
  Eigen::Matrix3d K_inverse;
  K_inverse << 1 / camera.fx, 0, -camera.cx / camera.fx, 0, 1 / camera.fy, -camera.cy / camera.fy,
      0, 0, 1;
  return K_inverse.transpose() * EssentialMatrix(b_from_a) * K_inverse;
}

std::optional<double> SquaredSampsonDistance(const Eigen::Matrix3d& fundamental,
                                             const Eigen::Vector2d& px_a,
                                             const Eigen::Vector2d& px_b) {
  const Eigen::Vector3d line_in_b = fundamental * px_a.homogeneous();
  const Eigen::Vector3d line_in_a = fundamental.transpose() * px_b.homogeneous();
  const double error = px_b.homogeneous().dot(line_in_b);
  const double gradient = line_in_b.head<2>().squaredNorm() + line_in_a.head<2>().squaredNorm();
  if (!(gradient > 0)) return std::nullopt;
  return error * error / gradient;
}

}  // namespace plumbline
