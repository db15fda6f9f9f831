// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumbline {

// Ids of keyframes, points and lines where they are shown: the values of the map's ids.
using ShownId = std::uint32_t;

using ShownPoint = std::array<float, 3>;  // place in the world

// A line as it is shown.
struct ShownLine {
  std::array<float, 6> ends{};  // both ends in the world
  // Whether at least four keyframes see it, as many as a line of the line map needs.
  bool established = false;

  friend bool operator==(const ShownLine&, const ShownLine&) = default;
};

// A keyframe as it is shown.
struct ShownKeyFrame {
  static constexpr std::uint32_t kOfAnotherRun = 0xFFFFFFFF;
  std::uint32_t frame = 0;  // number of its frame in this run
  // World from rectified camera: position, then the quaternion as x y z w.
  std::array<float, 7> pose{};

  friend bool operator==(const ShownKeyFrame&, const ShownKeyFrame&) = default;
};

// The changes of one kind of things since the last look.
template <class T>
struct ShownChanges {
  std::vector<std::pair<ShownId, T>> set;  // things that are new or have another place
  std::vector<ShownId> gone;

  bool empty() const { return set.empty() && gone.empty(); }
};

// The changes of the active map since the last look.
struct MapChanges {
  MapId map;
  // The map is another one than before: what was shown is to be forgotten.
  bool everything = false;
  ShownChanges<ShownPoint> points;
  ShownChanges<ShownLine> lines;
  ShownChanges<ShownKeyFrame> keyframes;
  // Keyframes that see the same, the newer one first.
  std::vector<std::pair<ShownId, ShownId>> edges;

  bool empty() const {
    return !everything && points.empty() && lines.empty() && keyframes.empty() && edges.empty();
  }
};

}  // namespace plumbline
