// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumbline {

// Names of keyframes, points and lines where they are shown: the values of their ids.
using ShownId = std::uint32_t;

using ShownPoint = std::array<float, 3>;  // world
using ShownLine = std::array<float, 6>;   // both ends, world

// A keyframe where it is shown.
struct ShownKeyFrame {
  static constexpr std::uint32_t kOfAnotherRun = 0xFFFFFFFF;
  std::uint32_t frame = 0;  // its number in this run
  // World from rectified camera: position, then the quaternion x y z w.
  std::array<float, 7> pose{};

  friend bool operator==(const ShownKeyFrame&, const ShownKeyFrame&) = default;
};

// What became of one kind of things since the last time.
template <class T>
struct ShownChanges {
  std::vector<std::pair<ShownId, T>> set;  // new, or with another place
  std::vector<ShownId> gone;

  bool empty() const { return set.empty() && gone.empty(); }
};

// What became of the active map since it was last looked at.
struct MapChanges {
  MapId map;
  bool everything = false;  // another map than before: what was shown is to be forgotten
  ShownChanges<ShownPoint> points;
  ShownChanges<ShownLine> lines;
  ShownChanges<ShownKeyFrame> keyframes;
  std::vector<std::pair<ShownId, ShownId>> edges;  // keyframes that see the same, newer one first

  bool empty() const {
    return !everything && points.empty() && lines.empty() && keyframes.empty() && edges.empty();
  }
};

}  // namespace plumbline
