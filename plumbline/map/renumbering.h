// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/map.h"

#include <cstdint>
#include <vector>

namespace plumbline {

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
