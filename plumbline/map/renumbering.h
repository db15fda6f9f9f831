// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/map.h"

#include <cstdint>
#include <vector>

namespace plumbline {

// What is added to the ids of a map that is to stand beside others in one atlas, or become part of
// one of them: the number of ids that these have used.
struct IdOffsets {
  std::int64_t maps = 0, keyframes = 0, points = 0, lines = 0;
  std::vector<SessionId> sessions;  // new id of each session; later ones keep theirs

  MapId operator()(MapId id) const { return Behind(id, maps); }
  KeyFrameId operator()(KeyFrameId id) const { return Behind(id, keyframes); }
  PointId operator()(PointId id) const { return Behind(id, points); }
  LineId operator()(LineId id) const { return Behind(id, lines); }
  SessionId operator()(SessionId id) const;

 private:
  // An id that names nothing stays as it is.
  template <class SomeId>
  static SomeId Behind(SomeId id, std::int64_t offset) {
    return id.valid() ? SomeId{id.value + offset} : id;
  }
};

// Returns the offsets that put ids behind all that a map has used; sessions stay.
IdOffsets Behind(const Map& map);

// Returns the map with other ids, those of removed and merged objects included. Nothing else
// changes. Throws InputError where ids become greater than a map can have. O(observations).
Map Renumbered(const Map& map, const IdOffsets& offsets);

}  // namespace plumbline
