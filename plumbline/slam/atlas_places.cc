// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/atlas_places.h"

namespace plumbline {
namespace {

// Adds the keyframes after `newest`. Ids ascend over all maps of an atlas, so that a keyframe made
// later has a greater id, whichever map it is in.
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

const Map* MapOf(const Atlas& atlas, KeyFrameId id) {
  for (const auto& [map_id, map] : atlas.maps()) {
    if (map.Find(id) != nullptr) return &map;
  }
  return nullptr;
}

void Follow(const Atlas& atlas, PlaceIndex* index) {
  const KeyFrameId newest = index->Newest();
  for (const auto& [id, map] : atlas.maps()) AddNew(map, newest, index);
  if (index->size() == KeyFramesOf(atlas)) return;
  for (const KeyFrameId id : index->Ids()) {
    if (MapOf(atlas, id) == nullptr) index->Remove(id);
  }
  if (index->size() == KeyFramesOf(atlas)) return;
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
