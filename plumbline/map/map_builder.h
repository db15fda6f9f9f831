// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <string>

namespace plumbline {

// Upper bound (exclusive) of all ids of a map to be built. A map has an index of all of its ids, a
// pointer for every 64 of them, whose size a forged file must not choose freely. Continuous
// recording assigns about 600 ids a second to points, so that the bound lasts for ten days.
inline constexpr std::int64_t kMaxBuiltId = std::int64_t{1} << 29;

// Builds a map from its saved parts: Map::Record, its keyframes, its points, its lines, each kind
// in the order of the ids. Inconsistent parts throw InputError "<source>: expected a map that
// agrees with itself, found ...", so that the result of Finish is valid for all functions of Map.
// Cost: O(observations) and some searches.
class MapBuilder {
 public:
  // `source` names the origin of the map in messages.
  MapBuilder(const MapRecord& record, std::string source);

  // Adds a keyframe. Its matches are cleared, since they follow from the observations of the
  // landmarks. Its features must have the map's correction (BugError).
  void Add(KeyFrame keyframe);
  // Adds a landmark, after all keyframes that observe it.
  void Add(MapPoint point);
  void Add(MapLine line);

  // The map of all parts added so far.
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
