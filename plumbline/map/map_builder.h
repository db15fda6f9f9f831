// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/map/map_record.h"

#include <string>

namespace plumbline {

// All ids of a map to be built must be less than this, because a map has an index of all of its
// ids: a pointer for every 64 of them, which a forged file must not make as large as it likes. A
// camera that never stops gives about 600 ids a second to points, which is enough for ten days.
inline constexpr std::int64_t kMaxBuiltId = std::int64_t{1} << 29;

// Makes a map from its saved parts: Map::Record, its keyframes, its points, its lines, each kind in
// the order of the ids. The parts are checked: for what no map can be it throws InputError
// "<source>: expected a map that agrees with itself, found ...", so that the result of Finish
// serves all functions of Map. Cost: O(observations) and some searches.
class MapBuilder {
 public:
  // `source` names the origin of the map in messages.
  MapBuilder(MapRecord record, std::string source);

  // Adds a keyframe. Its matches are cleared, since they follow from the observations of the
  // landmarks. Its features must have the map's correction (BugError).
  void Add(KeyFrame keyframe);
  // Adds a landmark, after all keyframes that observe it.
  void Add(MapPoint point);
  void Add(MapLine line);

  // The map of all parts that were added so far.
  const Map& map() const { return map_; }

  Map Finish();

 private:
  void CheckRecord(const MapRecord& record) const;
  void CheckParents() const;
  template <class LandmarkId, class Landmark>
  void AddLandmark(LandmarkId next, Landmark landmark, IdTable<LandmarkId, Landmark>& table);
  [[noreturn]] void Fail(const std::string& what) const;

  Map map_;
  std::string source_;
};

}  // namespace plumbline
