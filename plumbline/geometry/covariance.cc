// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/covariance.h"

#include "plumbline/geometry/eigenpairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumbline {

double LargestSigma(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(0.0, EigenvaluesOf<3>(covariance)(2)));
}

}  // namespace plumbline
