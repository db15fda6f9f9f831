// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace plumbline {

// Returns the middle value; of an even number of values the upper one of the two, and 0 of none.
// Changes the order of the values. O(n).
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
