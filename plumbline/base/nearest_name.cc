// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

std::string_view LastPart(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

// Returns the part of a dotted name before its last part; empty without a dot.
std::string_view GroupOf(std::string_view name) {
  return name.substr(0, name.size() - LastPart(name).size());
}

// Returns the candidate of least distance to `name` in the group that is nearest to that of `name`
// and not too different.
std::optional<std::string> NearestInGroup(std::string_view name,
                                          std::span<const std::string> candidates) {
  const std::string_view group = GroupOf(name);
  if (group.empty()) return std::nullopt;
  std::optional<std::string> best;
  std::pair best_distance(std::max<std::size_t>(2, group.size() / 3) + 1, std::size_t{0});
  for (const std::string& candidate : candidates) {
    const std::pair distance(EditDistance(group, GroupOf(candidate)),
                             EditDistance(LastPart(name), LastPart(candidate)));
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

std::size_t EditDistance(std::string_view a, std::string_view b) {
  // Rows of the table of distances between the first i characters of a and the first j of b.
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::optional<std::string> NearestName(std::string_view name,
                                       std::span<const std::string> candidates) {
  // No name is longer; distances of megabytes would take minutes.
  constexpr std::size_t kLongest = 200;
  if (name.size() > kLongest) return std::nullopt;
  const std::string_view last = LastPart(name);
  const std::size_t limit = std::max<std::size_t>(2, last.size() / 2);
  std::optional<std::string> best;
  std::size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance =
        std::min(EditDistance(name, candidate), EditDistance(last, LastPart(candidate)) + 1);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best ? best : NearestInGroup(name, candidates);
}

}  // namespace plumbline
