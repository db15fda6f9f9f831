// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// A line in the world with what the residuals of all its measurements need of it, computed once.
struct PreparedLine {
  explicit PreparedLine(const OrthonormalLine& line);

  Vector6d homogeneous;                       // moment, direction
  Eigen::Matrix<double, 6, 4> J_orthonormal;  // of these by the orthonormal update
};

}  // namespace plumbline
