// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/atlas.h"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline {

// Ids of displayed keyframes, points and lines: the values of the map's ids.
using ShownId = std::uint32_t;

using ShownPoint = std::array<float, 3>;  // position in the world

// A line for display.
struct ShownLine {
  std::array<float, 6> ends{};  // both ends in the world
  // True if at least four keyframes see it, the minimum for a line of the line map.
  bool established = false;

  friend bool operator==(const ShownLine&, const ShownLine&) = default;
};

// A keyframe for display.
struct ShownKeyFrame {
  static constexpr std::uint32_t kOfAnotherRun = 0xFFFFFFFF;
  std::uint32_t frame = 0;  // number of its frame in this run
  // World from rectified camera: position, then the quaternion as x y z w.
  std::array<float, 7> pose{};

  friend bool operator==(const ShownKeyFrame&, const ShownKeyFrame&) = default;
};

// Changes of one kind of objects since the last comparison.
template <class T>
struct ShownChanges {
  std::vector<std::pair<ShownId, T>> set;  // new or changed objects
  std::vector<ShownId> gone;

  bool empty() const { return set.empty() && gone.empty(); }
};

// Changes of the active map since the last comparison.
struct MapChanges {
  MapId map;
  // True if the active map has been replaced: viewers must discard the previous one.
  bool everything = false;
  ShownChanges<ShownPoint> points;
  ShownChanges<ShownLine> lines;
  ShownChanges<ShownKeyFrame> keyframes;
  // Pairs of covisible keyframes, the newer one first.
  std::vector<std::pair<ShownId, ShownId>> edges;

  bool empty() const {
    return !everything && points.empty() && lines.empty() && keyframes.empty() && edges.empty();
  }
};

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
