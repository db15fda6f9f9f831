// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

// Poses and lines as the numbers of the manifolds in ceres_manifolds.h.

namespace plumbline::testing {

inline Eigen::VectorXd PoseNumbers(const Rigid3& pose) {
  Eigen::VectorXd x(7);
  x << pose.rotation.coeffs(), pose.translation;
  return x;
}

inline Eigen::VectorXd LineNumbers(const OrthonormalLine& line) {
  Eigen::VectorXd x(6);
  x << line.U.coeffs(), line.w;
  return x;
}

}  // namespace plumbline::testing
