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
  const MapId id{maps_.empty() ? 0 : maps_.rbegin()->first.value + 1};
  maps_.emplace(id, Map(id));
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
  maps_.emplace(id, std::move(map));
}

KeyFrameId Atlas::NextKeyFrameId() const {
  KeyFrameId next{0};
  for (const auto& [id, map] : maps_) next = std::max(next, map.NextKeyFrameId());
  return next;
}

}  // namespace plumbline
