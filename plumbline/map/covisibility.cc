// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <map>

namespace plumbline {
namespace {

template <class LandmarkId>
void CountShared(const Map& map,
                 const std::vector<LandmarkId>& matches,
                 std::map<KeyFrameId, int>& shared) {
  for (const LandmarkId id : matches) {
    if (!id.valid()) continue;
    for (const auto& [keyframe, feature] : map.Find(id)->observations) ++shared[keyframe];
  }
}

}  // namespace

std::vector<CovisibleKeyFrame> RankByShared(const std::map<KeyFrameId, int>& shared,
                                            int min_shared) {
  std::vector<CovisibleKeyFrame> result;
  for (const auto& [id, count] : shared) {
    if (count >= min_shared) result.push_back({id, count});
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return a.shared != b.shared ? a.shared > b.shared : a.id > b.id;
  });
  return result;
}

std::vector<CovisibleKeyFrame> Covisible(const Map& map, KeyFrameId id, int min_shared) {
  const KeyFrame* keyframe = map.Find(id);
  if (keyframe == nullptr) return {};
  std::map<KeyFrameId, int> shared;
  CountShared(map, keyframe->frame.points, shared);
  CountShared(map, keyframe->frame.lines, shared);
  shared.erase(id);
  return RankByShared(shared, min_shared);
}

}  // namespace plumbline
