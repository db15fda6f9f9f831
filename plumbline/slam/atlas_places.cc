// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/atlas_places.h"

#include <algorithm>

namespace plumbline {
namespace {

bool AnyHas(const Atlas& atlas, KeyFrameId id) {
  return std::any_of(atlas.maps().begin(), atlas.maps().end(), [&](const auto& entry) {
    return entry.second.Find(id) != nullptr;
  });
}

// Keyframes are newer than all that came before, in whatever map they are.
void AddNew(const Map& map, KeyFrameId newest, PlaceIndex* index) {
  for (auto it = map.keyframes().upper_bound(newest); it != map.keyframes().end(); ++it) {
    index->Add(it->first, it->second.frame.features());
  }
}

std::size_t KeyFramesOf(const Atlas& atlas) {
  std::size_t count = 0;
  for (const auto& [id, map] : atlas.maps()) count += map.keyframes().size();
  return count;
}

}  // namespace

void Follow(const Atlas& atlas, PlaceIndex* index) {
  const KeyFrameId newest = index->Newest();
  for (const auto& [id, map] : atlas.maps()) AddNew(map, newest, index);
  if (index->size() == KeyFramesOf(atlas)) return;
  for (const KeyFrameId id : index->Ids()) {
    if (!AnyHas(atlas, id)) index->Remove(id);
  }
  for (const auto& [map_id, map] : atlas.maps()) {  // adopted maps have older ones
    for (const auto& [id, keyframe] : map.keyframes()) {
      if (!index->Contains(id)) index->Add(id, keyframe.frame.features());
    }
  }
}

std::vector<KeyFrameId> MostAlike(const PlaceIndex& index,
                                  const Map& map,
                                  const Features& features,
                                  std::size_t most) {
  const auto in_map = [&](KeyFrameId id) { return map.Find(id) != nullptr; };
  std::vector<KeyFrameId> ids;
  for (const PlaceCandidate& candidate : index.Query(features, most, in_map)) {
    ids.push_back(candidate.id);
  }
  return ids;
}

}  // namespace plumbline
