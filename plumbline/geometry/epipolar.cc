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

}  // namespace plumbline
