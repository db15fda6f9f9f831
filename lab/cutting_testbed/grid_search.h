// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

struct GridMaximum {
  Eigen::Vector2d ratios = Eigen::Vector2d::Zero();
  double value = -std::numeric_limits<double>::infinity();
};

// Returns the maximum over all pairs of ratios 0, 1/steps, ..., 1 with first <= second.
template <class Objective>
GridMaximum SearchGrid(const Objective& objective, int steps) {
  GridMaximum best;
  Eigen::Vector2d gradient;
  for (int i = 0; i <= steps; ++i) {
    for (int k = i; k <= steps; ++k) {
      const Eigen::Vector2d ratios(static_cast<double>(i) / steps, static_cast<double>(k) / steps);
      const double value = objective(ratios, gradient);
      if (value > best.value) best = {ratios, value};
    }
  }
  return best;
}

// All values, row by second ratio, column by first, both orders: a symmetric matrix.
template <class Objective>
Eigen::MatrixXd SurfaceOf(const Objective& objective, int steps) {
  Eigen::MatrixXd surface(steps + 1, steps + 1);
  Eigen::Vector2d gradient;
  for (int i = 0; i <= steps; ++i) {
    for (int k = 0; k <= steps; ++k) {
      surface(k, i) =
          objective({static_cast<double>(i) / steps, static_cast<double>(k) / steps}, gradient);
    }
  }
  return surface;
}

}  // namespace plumbline
