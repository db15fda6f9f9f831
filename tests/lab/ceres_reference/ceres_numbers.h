// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/ceres_reference/ceres_manifolds.h"

#include <Eigen/Core>

// Poses and lines as the numbers of the manifolds in ceres_manifolds.h.

namespace plumbline::testing {

inline Eigen::VectorXd PoseNumbers(const Rigid3& pose) {
  Eigen::VectorXd x(7);
  WritePose(pose, x.data());
  return x;
}

inline Eigen::VectorXd LineNumbers(const OrthonormalLine& line) {
  Eigen::VectorXd x(6);
  WriteLine(line, x.data());
  return x;
}

}  // namespace plumbline::testing
