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

// Finds what has changed in the active map of an atlas since the last look. Landmarks that moved by
// less than a 2000th of their distance from the newest keyframe, half a pixel of most cameras, stay
// where they were shown until such moves add up. It remembers what it told: 16 bytes a point, 28 a
// line.
class MapComparison {
 public:
  // Most keyframes whose neighbours are found in one look; others come with the next looks.
  static constexpr std::size_t kNeighboursAtOnce = 16;
  // Most neighbours of a keyframe that are told: older ones that show most of what it shows.
  static constexpr int kNeighbours = 4;

  // session: the one of the run that is shown; keyframes of others are kOfAnotherRun. nullopt: the
  // map was saved, and each keyframe has the number that it had in its run.
  explicit MapComparison(std::optional<SessionId> session) : session_(session) {}

  // Finds what changed since the last look, by pages of the map's tables. Cost: some 30 ns for each
  // landmark of a page in which one changed.
  MapChanges Compare(const Atlas& atlas);
  // Whether there are keyframes left whose neighbours were not searched yet.
  bool HasMore() const { return !without_neighbours_.empty(); }

 private:
  // What was told of one table, by its pages, and the table's number of changes at that time.
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
  KeyFrameId newest_;                           // the newest keyframe that was told
  std::vector<KeyFrameId> without_neighbours_;  // ascending
};

}  // namespace plumbline
