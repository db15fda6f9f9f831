// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/map/map.h"

#include <map>

namespace plumbline {

// The maps of one system. Keyframes and landmarks have ids that no other map of the atlas uses, so
// that maps can be joined without renaming anything. Ids ascend in the order of creation. At most
// one map grows at a time, the active one.
class Atlas {
 public:
  const std::map<MapId, Map>& maps() const { return maps_; }
  bool empty() const { return maps_.empty(); }
  // Returns nullptr if the atlas has no map of this id.
  const Map* Find(MapId id) const;
  Map* Find(MapId id);

  // The active map. Before the first map its id is invalid, and access to the map throws BugError.
  MapId active_id() const { return active_; }
  const Map& active() const;
  Map& active();

  // Creates an empty map and makes it the active one.
  Map& Start();
  // Makes a map of the atlas the active one. Throws BugError for an unknown id.
  Map& Activate(MapId id);
  // Adds an existing map, for instance a saved one, under its own id, without activating it. Throws
  // BugError if the atlas has a map of this id.
  void Adopt(Map map);

  // Merges two maps into one (Map::Absorb). `gone` is absorbed by `kept` and leaves the atlas;
  // `kept` becomes the active map if `gone` was. Throws BugError if one of them is missing or
  // `kept` is not the older one. If it throws, both are unchanged.
  Map& Join(MapId kept, MapId gone, const Similarity3& kept_from_gone);
  // Returns the map that contains `id` now: itself, or the map that absorbed it.
  MapId Current(MapId id) const;
  // Absorbed maps, each with the map that absorbed it.
  const std::map<MapId, MapId>& joined() const { return joined_; }

  // Returns the id that the next map gets.
  MapId NextMapId() const { return next_map_; }
  // Returns the first id that no keyframe of any map has had.
  KeyFrameId NextKeyFrameId() const;

 private:
  std::map<MapId, Map> maps_;
  std::map<MapId, MapId> joined_;
  MapId active_;
  MapId next_map_{0};
};

}  // namespace plumbline
