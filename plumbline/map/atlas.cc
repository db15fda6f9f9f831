// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/atlas.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <utility>

namespace plumbline {

const Map* Atlas::Find(MapId id) const {
  const auto found = maps_.find(id);
  return found == maps_.end() ? nullptr : &found->second;
}

Map* Atlas::Find(MapId id) {
  const auto found = maps_.find(id);
  return found == maps_.end() ? nullptr : &found->second;
}

const Map& Atlas::active() const {
  const Map* map = Find(active_);
  PLUMBLINE_CHECK(map != nullptr, "there is no active map");
  return *map;
}

Map& Atlas::active() { return const_cast<Map&>(std::as_const(*this).active()); }

Map& Atlas::Start() {
  const MapId id = next_map_;
  maps_.emplace(id, Map(id));
  next_map_ = MapId{id.value + 1};
  return Activate(id);
}

Map& Atlas::Activate(MapId id) {
  Map* map = Find(id);
  PLUMBLINE_CHECK(map != nullptr, "a map that is not in the atlas");
  for (const auto& [other_id, other] : maps_) {
    map->ReserveIds(other.NextPointId(), other.NextLineId());
  }
  active_ = id;
  return *map;
}

void Atlas::Adopt(Map map) {
  const MapId id = map.id();
  PLUMBLINE_CHECK(id.valid() && Find(id) == nullptr, "id of an adopted map is not new");
  next_map_ = std::max(next_map_, MapId{id.value + 1});
  maps_.emplace(id, std::move(map));
}

Map& Atlas::Join(MapId kept, MapId gone, const Similarity3& kept_from_gone) {
  Map* map = Find(kept);
  const auto other = maps_.find(gone);
  PLUMBLINE_CHECK(map != nullptr && other != maps_.end() && kept < gone, "maps cannot be joined");
  joined_[gone] = kept;
  try {
    map->Absorb(Map(other->second), kept_from_gone);
  } catch (...) {
    joined_.erase(gone);
    throw;
  }
  maps_.erase(other);
  return active_ == gone ? Activate(kept) : *map;
}

MapId Atlas::Current(MapId id) const {
  for (auto it = joined_.find(id); it != joined_.end(); it = joined_.find(id)) id = it->second;
  return id;
}

KeyFrameId Atlas::NextKeyFrameId() const {
  KeyFrameId next{0};
  for (const auto& [id, map] : maps_) next = std::max(next, map.NextKeyFrameId());
  return next;
}

}  // namespace plumbline
