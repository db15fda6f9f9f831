// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"
#include "plumbline/viewer/map_changes.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline {

// Finds the changes of the active map of an atlas since the last comparison. Landmarks that moved
// by less than a 2000th of their distance from the newest keyframe, half a pixel of most cameras,
// keep their displayed position until such motions add up. Memory: 16 bytes a point, 28 a line.
class MapComparison {
 public:
  // Largest number of keyframes whose neighbours are searched in one comparison; others follow in
  // the next ones.
  static constexpr std::size_t kNeighboursAtOnce = 16;
  // Largest number of neighbours of a keyframe that are reported: the older ones with most shared
  // landmarks.
  static constexpr int kNeighbours = 4;

  // session: that of the displayed run; keyframes of others are kOfAnotherRun. nullopt: a saved
  // map, whose keyframes have the frame numbers of their own runs.
  explicit MapComparison(std::optional<SessionId> session) : session_(session) {}

  // Finds the changes since the last call, by pages of the map's tables. Cost: some 30 ns for each
  // landmark of a changed page.
  MapChanges Compare(const Atlas& atlas);
  // Returns true if the neighbours of some keyframes have not been searched yet.
  bool HasMore() const { return !without_neighbours_.empty(); }

 private:
  // Reported content of one table, by its pages, and the table's number of changes at that time.
  template <class T>
  struct Shown {
    std::vector<std::vector<std::pair<ShownId, T>>> pages;  // each page is ordered by id
    std::uint64_t changes = 0;
  };

  template <class Table, class T>
  ShownChanges<T> CompareTable(const Table& table, const ShownPoint& eye, Shown<T>& shown) const;
  void AddEdges(const Map& map, MapChanges& changes);

  std::optional<SessionId> session_;
  std::optional<MapId> map_;
  Shown<ShownPoint> points_;
  Shown<ShownLine> lines_;
  Shown<ShownKeyFrame> keyframes_;
  KeyFrameId newest_;                           // newest reported keyframe
  std::vector<KeyFrameId> without_neighbours_;  // ascending
};

}  // namespace plumbline
