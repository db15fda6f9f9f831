// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <vector>

namespace plumbline {

struct CovisibleKeyFrame {
  KeyFrameId id;
  int shared = 0;  // points and lines that both show
};

// Counts, for each keyframe of a map, the landmarks that it shows of those given.
class SharedCounts {
 public:
  explicit SharedCounts(const Map& map);

  void Add(const Observations& observations);
  void Leave(KeyFrameId id);  // out of the ranking

  // Keyframes by their number, most first (ties: newest first), those below min_shared left out.
  std::vector<CovisibleKeyFrame> Rank(int min_shared) const;

 private:
  std::vector<int> shared_;  // by id
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
