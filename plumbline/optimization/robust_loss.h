// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>

namespace plumbline {

// Huber's loss of a squared Mahalanobis norm s: s up to the square of the threshold k, from there
// on 2 k sqrt(s) - k^2, which grows like the norm itself. k = infinity gives plain squares.
inline double HuberLoss(double s, double k) {
  return s <= k * k ? s : 2 * k * std::sqrt(s) - k * k;
}

// Its derivative with respect to s: the weight of the residual in the normal equations.
inline double HuberWeight(double s, double k) { return s <= k * k ? 1.0 : k / std::sqrt(s); }

// Thresholds of the Huber loss on the Mahalanobis norm, by kind of residual.
struct HuberThresholds {
  double point = std::numeric_limits<double>::infinity();
  double disparity = std::numeric_limits<double>::infinity();  // of a point with disparity
  double line = std::numeric_limits<double>::infinity();
};

// The value that a chi2 variable with `dof` >= 1 degrees of freedom stays below with 95 %. Exact to
// 1e-3 for dof <= 12, else by the approximation of Wilson and Hilferty (error below 0.1 %).
inline double Chi2Limit95(int dof) {
  constexpr std::array kLimits{0.0,
                               3.841,
                               5.991,
                               7.815,
                               9.488,
                               11.070,
                               12.592,
                               14.067,
                               15.507,
                               16.919,
                               18.307,
                               19.675,
                               21.026};
  if (dof < static_cast<int>(kLimits.size())) return kLimits[static_cast<std::size_t>(dof)];
  const double a = 2.0 / (9.0 * dof);
  const double root = 1 - a + 1.6448536 * std::sqrt(a);
  return dof * root * root * root;
}

}  // namespace plumbline
