// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/map.h"

#include <map>

namespace plumbline {

// The maps of one system. Keyframes and landmarks have ids that no other map of the atlas uses, so
// that maps can be joined without renaming anything; ids ascend in the order of creation. At most
// one map grows at a time, the active one.
class Atlas {
 public:
  const std::map<MapId, Map>& maps() const { return maps_; }
  bool empty() const { return maps_.empty(); }
  // nullptr where there is none.
  const Map* Find(MapId id) const;
  Map* Find(MapId id);

  // The map that grows; invalid, or a BugError, before the first.
  MapId active_id() const { return active_; }
  const Map& active() const;
  Map& active();

  // Opens an empty map and makes it the active one.
  Map& Start();
  // Goes on with a map of the atlas (BugError where there is none).
  Map& Activate(MapId id);
  // Takes in a map as it is, under its own id, without making it active: one that was saved. No map
  // of this id may be there (BugError).
  void Adopt(Map map);

  // The first id that no keyframe of any map has had.
  KeyFrameId NextKeyFrameId() const;

 private:
  std::map<MapId, Map> maps_;
  MapId active_;
};

}  // namespace plumbline
