// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/stamp_pairs.h"

#include <algorithm>
#include <cstdlib>

namespace plumbline {
namespace {

// Returns the index of the nearest time, the earlier of two equally near ones. `stamps` must not be
// empty.
std::size_t Nearest(const std::vector<std::int64_t>& stamps, std::int64_t stamp_ns) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp_ns);
  const auto index = static_cast<std::size_t>(after - stamps.begin());
  if (after == stamps.begin()) return 0;
  if (after == stamps.end()) return index - 1;
  return stamp_ns - stamps[index - 1] <= *after - stamp_ns ? index - 1 : index;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> PairByStamp(
    const std::vector<std::int64_t>& first,
    const std::vector<std::int64_t>& second,
    std::int64_t most_ns) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (second.empty()) return pairs;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::size_t nearest = Nearest(second, first[i]);
    if (std::abs(second[nearest] - first[i]) > most_ns) continue;
    if (Nearest(first, second[nearest]) == i) pairs.emplace_back(i, nearest);
  }
  return pairs;
}

}  // namespace plumbline
