// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/multifrontal_cholesky.h"

#include "tests/optimization/random_scene.h"
#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

namespace plumbline::testing {

// The pattern of pairs of rows, each in any order.
inline BlockPattern PatternOf(int rows, const std::set<std::pair<int, int>>& pairs) {
  BlockPattern pattern(static_cast<std::size_t>(rows));
  for (const auto& [a, b] : pairs) {
    if (a != b) pattern[static_cast<std::size_t>(std::max(a, b))].push_back(std::min(a, b));
  }
  for (auto& row : pattern) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return pattern;
}

// A path in which each row meets those up to `reach` before it, and that comes back to where it
// began after `round` rows.
inline BlockPattern PathPattern(int rows, int reach, int round) {
  std::set<std::pair<int, int>> pairs;
  for (int a = 0; a < rows; ++a) {
    for (int b = 0; b < a; ++b) {
      const int apart = (a - b) % round;
      if (a - b <= reach || apart <= reach || round - apart <= reach) pairs.insert({a, b});
    }
  }
  return PatternOf(rows, pairs);
}

inline BlockPattern RandomPattern(unsigned seed, int rows, int pairs) {
  Random random(seed);
  std::set<std::pair<int, int>> chosen;
  for (int i = 0; i < pairs; ++i) {
    const int a = random.Index(rows);
    chosen.insert({a, random.Index(rows)});
  }
  return PatternOf(rows, chosen);
}

// Paths with and without loops, anything, nothing at all, and all with all.
inline std::vector<BlockPattern> ManyPatterns() {
  return {PathPattern(40, 3, 1000),
          PathPattern(60, 2, 20),
          PathPattern(90, 4, 85),
          RandomPattern(1, 30, 40),
          RandomPattern(2, 50, 60),
          RandomPattern(3, 25, 200),
          BlockPattern(7),
          BlockPattern(1),
          PathPattern(12, 12, 1000)};
}

}  // namespace plumbline::testing
