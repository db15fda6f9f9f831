// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/map.h"
#include "plumbline/map/saved_atlas.h"

#include <cstdint>
#include <vector>

namespace plumbline {

// The maps of two saved atlases, combined in one atlas.
struct CombinedAtlases {
  SavedAtlas saved;  // its active map is that of the first atlas
  // Active map of the second atlas; invalid if it has none.
  MapId second;
};

// Combines the maps of two atlases of the same camera. Maps of the first keep their ids, those of
// the second get ids after them (Renumbered). Sessions with the same uuid become one. The evidence
// about the stereo pair is summed if it comes from one rig and different sessions, so that none
// counts twice; otherwise it is that of the first, as are camera, options and front end.
// O(observations of the second).
CombinedAtlases CombineAtlases(SavedAtlas first, const SavedAtlas& second);

// Hands the data kept beside each absorbed map to the map that absorbed it.
void SettleJoined(SavedAtlas& saved);

// Offsets of the ids of a map that joins others in one atlas, or is absorbed by one of them: the
// numbers of ids used there.
struct IdOffsets {
  std::int64_t maps = 0, keyframes = 0, points = 0, lines = 0;
  std::vector<SessionId> sessions;  // new id of each session; later ones are unchanged

  MapId operator()(MapId id) const { return Behind(id, maps); }
  KeyFrameId operator()(KeyFrameId id) const { return Behind(id, keyframes); }
  PointId operator()(PointId id) const { return Behind(id, points); }
  LineId operator()(LineId id) const { return Behind(id, lines); }
  SessionId operator()(SessionId id) const;

 private:
  // An invalid id is unchanged.
  template <class SomeId>
  static SomeId Behind(SomeId id, std::int64_t offset) {
    return id.valid() ? SomeId{id.value + offset} : id;
  }
};

// Returns the offsets that put ids after all ids of a map; sessions are unchanged.
IdOffsets Behind(const Map& map);

// Returns the map with shifted ids, including those of removed and merged objects. Nothing else
// changes. Throws InputError if an id exceeds the largest of a map. O(observations).
Map Renumbered(const Map& map, const IdOffsets& offsets);

}  // namespace plumbline
