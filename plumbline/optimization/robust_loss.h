// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace plumbline {

// Returns Huber's loss of a squared Mahalanobis norm s. The loss is s up to the square of the
// threshold k; from there on it is 2 k sqrt(s) - k^2, which grows like the norm itself. k =
// infinity gives plain squares.
inline double HuberLoss(double s, double k) {
  return s <= k * k ? s : 2 * k * std::sqrt(s) - k * k;
}

// Returns the derivative of HuberLoss with respect to s: the weight of the residual in the normal
// equations.
inline double HuberWeight(double s, double k) { return s <= k * k ? 1.0 : k / std::sqrt(s); }

// Thresholds of the Huber loss on the Mahalanobis norm, by kind of residual.
struct HuberThresholds {
  double point = std::numeric_limits<double>::infinity();
  double disparity = std::numeric_limits<double>::infinity();  // for points with disparity
  double line = std::numeric_limits<double>::infinity();
};

// Huber thresholds of bundle adjustment and pose estimation: the square roots of the 95 % quantiles
// of chi2 with two, three and two degrees of freedom. Larger residuals are not noise.
inline constexpr HuberThresholds kHuberThresholds{
    .point = 2.4477, .disparity = 2.7955, .line = 2.4477};

}  // namespace plumbline
