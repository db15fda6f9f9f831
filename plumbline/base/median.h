// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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

}  // namespace plumbline
