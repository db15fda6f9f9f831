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
  // Returns nullptr where there is no such map.
  const Map* Find(MapId id) const;
  Map* Find(MapId id);

  // The map that grows. Before the first map its id is invalid, and asking for the map throws
  // BugError.
  MapId active_id() const { return active_; }
  const Map& active() const;
  Map& active();

  // Opens an empty map and makes it the active one.
  Map& Start();
  // Makes a map of the atlas the active one (BugError where there is none of this id).
  Map& Activate(MapId id);
  // Adds a map as it is, under its own id, without making it active, for instance a saved one. The
  // atlas must have no map of this id (BugError).
  void Adopt(Map map);

  // Makes one map of two (Map::Absorb). `kept` takes in `gone`, which leaves the atlas, and becomes
  // the active map if `gone` was. Throws BugError where one of them is missing, or `kept` is not
  // the older one. Where anything is thrown, both are as they were.
  Map& Join(MapId kept, MapId gone, const Similarity3& kept_from_gone);
  // Returns the map that `id` is part of today: itself, or the map that took it in.
  MapId Current(MapId id) const;
  // The maps that were taken in, each with the map that took it in.
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
