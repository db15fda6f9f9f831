// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace plumbline {

// Returns the median: of an even number of values the upper one of the two in the middle, 0 if
// empty. Reorders the values. O(n).
inline double UpperMedian(std::span<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
inline double UpperMedian(std::vector<double> values) {
  return UpperMedian(std::span<double>(values));
}

// The 95 % and 99 % quantiles of chi2 distributions with one and two degrees of freedom.
inline constexpr double kChi2OneDof95 = 3.841;
inline constexpr double kChi2TwoDof95 = 5.991;
inline constexpr double kChi2TwoDof99 = 9.21;

// Returns the 95 % quantile of the chi2 distribution with `dof` >= 1 degrees of freedom: exact to
// 1e-3 for dof <= 12, beyond that by the approximation of Wilson and Hilferty (error below 0.1 %).
inline double Chi2Limit95(int dof) {
  constexpr std::array kLimits{0.0,
                               kChi2OneDof95,
                               kChi2TwoDof95,
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
