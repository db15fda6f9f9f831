// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {

SharedCounts::SharedCounts(const Map& map)
    : shared_(static_cast<std::size_t>(map.NextKeyFrameId().value), 0) {}

void SharedCounts::Add(const Observations& observations) {
  for (const auto& [keyframe, feature] : observations) {
    ++shared_[static_cast<std::size_t>(keyframe.value)];
  }
}

void SharedCounts::Leave(KeyFrameId id) { shared_[static_cast<std::size_t>(id.value)] = 0; }

std::vector<CovisibleKeyFrame> SharedCounts::Rank(int min_shared) const {
  std::vector<CovisibleKeyFrame> result;
  for (std::size_t i = 0; i < shared_.size(); ++i) {
    if (shared_[i] >= std::max(min_shared, 1)) {
      result.push_back({KeyFrameId{static_cast<std::int64_t>(i)}, shared_[i]});
    }
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return a.shared != b.shared ? a.shared > b.shared : a.id > b.id;
  });
  return result;
}

std::vector<CovisibleKeyFrame> Covisible(const Map& map, KeyFrameId id, int min_shared) {
  const KeyFrame* keyframe = map.Find(id);
  if (keyframe == nullptr) return {};
  SharedCounts shared(map);
  const auto count = [&](const auto& matches) {
    for (const auto landmark : matches) {
      if (landmark.valid()) shared.Add(map.Find(landmark)->observations);
    }
  };
  count(keyframe->frame.points);
  count(keyframe->frame.lines);
  shared.Leave(id);
  return shared.Rank(min_shared);
}

std::vector<CovisibleKeyFrame> ClosestCovisible(const Map& map, KeyFrameId id, int most) {
  std::vector<CovisibleKeyFrame> closest = Covisible(map, id);
  if (static_cast<int>(closest.size()) > most) closest.resize(static_cast<std::size_t>(most));
  return closest;
}

}  // namespace plumbline
