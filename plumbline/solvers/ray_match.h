// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace plumbline
