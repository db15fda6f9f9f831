// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// A recognized place: the new keyframe shows the same place as an older one.
struct Recognition {
  FrameId frame;  // frame of the new keyframe
  KeyFrameId keyframe;
  KeyFrameId older;
  int points = 0;  // landmarks common to both keyframes
  int lines = 0;
  // Decimal logarithm of the probability that two different places agree so well by chance.
  double log10_chance = 0;
  // Distance that the correction moved the new keyframe [map unit].
  double moved = 0;
  double turned_deg = 0;
  double scale = 1;  // scale around the new keyframe after the correction / before
};

// Relocalization of a lost frame.
struct Relocalization {
  FrameId frame;
  KeyFrameId keyframe;  // candidate from which the pose was found
  int points = 0;       // inliers of the frame's pose
  int lines = 0;
};

// Merge of two maps.
struct MapJoin {
  Recognition place;
  MapId kept;
  MapId gone;
};

// Events that changed maps at large, each kind in order of time.
struct MapEvents {
  std::vector<Recognition> loops;
  std::vector<MapJoin> joins;
  std::vector<Relocalization> relocalizations;

  bool empty() const { return loops.empty() && joins.empty() && relocalizations.empty(); }
};

// Numbers of events of each kind already known to a reader.
struct MapEventCounts {
  std::size_t loops = 0;
  std::size_t joins = 0;
  std::size_t relocalizations = 0;
};

// Returns the events of one kind, or of all, after the first `known`, and counts them as known.
template <class Event>
std::vector<Event> TakeNew(const std::vector<Event>& all, std::size_t& known) {
  std::vector<Event> fresh(all.begin() + static_cast<std::ptrdiff_t>(known), all.end());
  known = all.size();
  return fresh;
}
inline MapEvents TakeNew(const MapEvents& all, MapEventCounts& known) {
  return {TakeNew(all.loops, known.loops),
          TakeNew(all.joins, known.joins),
          TakeNew(all.relocalizations, known.relocalizations)};
}

}  // namespace plumbline
