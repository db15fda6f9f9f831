// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <cstdint>

namespace plumbline {

void SharedCounts::Add(const Observations& observations) {
  for (const auto& [keyframe, feature] : observations) {
    const auto id = static_cast<std::size_t>(keyframe.value);
    if (pages_.size() <= id / kPage) pages_.resize(id / kPage + 1);
    std::vector<int>& page = pages_[id / kPage];
    if (page.empty()) page.resize(kPage, 0);
    ++page[id % kPage];
  }
}

void SharedCounts::Leave(KeyFrameId id) {
  const std::size_t page = static_cast<std::size_t>(id.value) / kPage;
  if (page < pages_.size() && !pages_[page].empty()) {
    pages_[page][static_cast<std::size_t>(id.value) % kPage] = 0;
  }
}

std::vector<CovisibleKeyFrame> SharedCounts::Rank(int min_shared) const {
  std::vector<CovisibleKeyFrame> result;
  for (std::size_t page = 0; page < pages_.size(); ++page) {
    for (std::size_t i = 0; i < pages_[page].size(); ++i) {
      const int shared = pages_[page][i];
      if (shared < std::max(min_shared, 1)) continue;
      result.push_back({KeyFrameId{static_cast<std::int64_t>(page * kPage + i)}, shared});
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
  SharedCounts shared;
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
