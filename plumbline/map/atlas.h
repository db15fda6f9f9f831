// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/geometry/sim3.h"
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

  // Makes one map of two (Map::Absorb): `kept` takes in `gone`, which leaves the atlas, and becomes
  // the active map if `gone` was. BugError where one of them is not there, or `kept` is not the
  // older.
  Map& Join(MapId kept, MapId gone, const Similarity3& kept_from_gone);
  // The map that `id` is part of today: itself, or the one that took it in.
  MapId Current(MapId id) const;
  // Maps that were taken in, and by which.
  const std::map<MapId, MapId>& joined() const { return joined_; }

  // What is not to be seen from the maps that there are: those that were taken in, and the id of
  // the next one. For an atlas that goes on as another one would.
  struct History {
    std::map<MapId, MapId> joined;
    MapId next_map{0};

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.joined, self.next_map);
    }
  };
  History history() const { return {joined_, next_map_}; }
  // BugError where a map would stand for one that is not there.
  void SetHistory(const History& history);

  // The first id that no keyframe of any map has had.
  KeyFrameId NextKeyFrameId() const;

 private:
  std::map<MapId, Map> maps_;
  std::map<MapId, MapId> joined_;
  MapId active_;
  MapId next_map_{0};
};

}  // namespace plumbline
