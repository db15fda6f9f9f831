// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <cstddef>
#include <vector>

namespace plumbline {

struct CovisibleKeyFrame {
  KeyFrameId id;
  int shared = 0;  // points and lines that both keyframes show
};

// Counts the given landmarks that each keyframe shows. Cost: that of the observations, and a 64th
// of an access for every keyframe id ever used.
class SharedCounts {
 public:
  void Add(const Observations& observations);
  void Leave(KeyFrameId id);  // removes a keyframe from the ranking

  // Returns the keyframes with at least min_shared, by descending count (ties: newest first).
  std::vector<CovisibleKeyFrame> Rank(int min_shared) const;

 private:
  static constexpr std::size_t kPage = 64;

  std::vector<std::vector<int>> pages_;  // kPage ids each; empty if none of them is counted
};

// Least number of common landmarks of two keyframes that see the same place; fewer may be wrong
// matches.
inline constexpr int kMinShared = 10;

// Returns the keyframes that show at least min_shared of the landmarks of `id`, by descending count
// (ties: newest first), without `id` itself. Computed from the observations at each call, O(matches
// x views).
std::vector<CovisibleKeyFrame> Covisible(const Map& map,
                                         KeyFrameId id,
                                         int min_shared = kMinShared);

// Returns the first `most` keyframes of Covisible().
std::vector<CovisibleKeyFrame> ClosestCovisible(const Map& map, KeyFrameId id, int most);

}  // namespace plumbline
