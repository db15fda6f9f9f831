// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <cstddef>
#include <vector>

namespace plumbline {

struct CovisibleKeyFrame {
  KeyFrameId id;
  int shared = 0;  // points and lines that both show
};

// Counts, for each keyframe, the landmarks that it shows of those given. Cost: that of the
// observations, and a 64th of a look for every id of a keyframe there ever was.
class SharedCounts {
 public:
  void Add(const Observations& observations);
  void Leave(KeyFrameId id);  // out of the ranking

  // Keyframes by their number, most first (ties: newest first), those below min_shared left out.
  std::vector<CovisibleKeyFrame> Rank(int min_shared) const;

 private:
  static constexpr std::size_t kPage = 64;

  std::vector<std::vector<int>> pages_;  // of kPage ids each; empty where none of them is shared
};

// Landmarks in common from which on two keyframes see the same place, not a few wrong matches.
inline constexpr int kMinShared = 10;

// The keyframes that show at least min_shared of the landmarks that `id` shows, most shared first
// (ties: newest first), without `id` itself. Derived from the observations at each call, O(matches
// x views).
std::vector<CovisibleKeyFrame> Covisible(const Map& map,
                                         KeyFrameId id,
                                         int min_shared = kMinShared);

// The first `most` of them.
std::vector<CovisibleKeyFrame> ClosestCovisible(const Map& map, KeyFrameId id, int most);

}  // namespace plumbline
