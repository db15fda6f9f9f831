// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <map>
#include <vector>

namespace plumbline {

struct CovisibleKeyFrame {
  KeyFrameId id;
  int shared = 0;  // points and lines that both show
};

// Keyframes by the number of landmarks they share with something, most first (ties: newest first),
// those below min_shared left out.
std::vector<CovisibleKeyFrame> RankByShared(const std::map<KeyFrameId, int>& shared,
                                            int min_shared);

// The keyframes that show at least min_shared of the landmarks that `id` shows, most shared first
// (ties: newest first), without `id` itself. Derived from the observations at each call, O(matches
// x views).
std::vector<CovisibleKeyFrame> Covisible(const Map& map, KeyFrameId id, int min_shared);

}  // namespace plumbline
