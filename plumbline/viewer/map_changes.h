// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <array>
#include <cstdint>
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

}  // namespace plumbline
