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

// Counts how many of the given landmarks each keyframe shows. Cost: that of the observations, and a
// 64th of a look for every keyframe id that was ever used.
class SharedCounts {
 public:
  void Add(const Observations& observations);
  void Leave(KeyFrameId id);  // takes a keyframe out of the ranking

  // Returns keyframes by their count, the highest first (ties: newest first). Keyframes with less
  // than min_shared are left out.
  std::vector<CovisibleKeyFrame> Rank(int min_shared) const;

 private:
  static constexpr std::size_t kPage = 64;

  std::vector<std::vector<int>> pages_;  // kPage ids each; empty where none of them is shared
};

// Number of common landmarks from which on two keyframes see the same place: fewer may be wrong
// matches.
inline constexpr int kMinShared = 10;

// Returns the keyframes that show at least min_shared of the landmarks that `id` shows, the most
// shared first (ties: newest first), without `id` itself. Computed from the observations at each
// call, O(matches x views).
std::vector<CovisibleKeyFrame> Covisible(const Map& map,
                                         KeyFrameId id,
                                         int min_shared = kMinShared);

// Returns the first `most` keyframes of Covisible().
std::vector<CovisibleKeyFrame> ClosestCovisible(const Map& map, KeyFrameId id, int most);

}  // namespace plumbline
