// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// A line in the world, prepared once for the residuals of all its measurements.
struct PreparedLine {
  explicit PreparedLine(const OrthonormalLine& line);

  Vector6d homogeneous;  // moment and direction
  // Derivative of moment and direction with respect to the orthonormal update.
  Eigen::Matrix<double, 6, 4> J_orthonormal;
};

}  // namespace plumbline
