// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/map/map_record.h"

#include <string>

namespace plumbline {

// Ids of a map to be built are below this: a map has an index of all of its ids.
inline constexpr std::int64_t kMaxBuiltId = std::int64_t{1} << 26;

// Makes a map from what was written down of one: Map::Record, its keyframes, its points, its lines,
// each kind in the order of the ids. Trusts nothing: throws InputError "<source>: expected a map
// that agrees with itself, found ..." for what no map can be, so that whatever Finish gives serves
// all functions of Map. Cost: O(observations) and some hash-free searches.
class MapBuilder {
 public:
  // `source` names where the map comes from in messages.
  MapBuilder(MapRecord record, std::string source);

  // Matches of the keyframe follow from the observations of the landmarks; those that it has are
  // cleared. Its features must have the map's stereo correction (BugError).
  void Add(KeyFrame keyframe);
  // After all keyframes that observe them.
  void Add(MapPoint point);
  void Add(MapLine line);

  // What was added so far.
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
