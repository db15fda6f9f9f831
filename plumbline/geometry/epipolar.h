// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// E = [t]x R: x_b . E x_a = 0 for rays of one point. Zero if the cameras share their centre. Chain
// poses and form E once: a product of essential matrices is not one.
inline Eigen::Matrix3d EssentialMatrix(const Rigid3& b_from_a) {
  return Skew(b_from_a.translation) * b_from_a.rotation.toRotationMatrix();
}

// The matrix F with x_b . F x_a = 0 for pixels (x, y, 1) of two rectified images.
Eigen::Matrix3d FundamentalMatrix(const RectifiedCamera& camera, const Rigid3& b_from_a);

}  // namespace plumbline
