// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// A place that was seen again: the new keyframe shows what an older keyframe showed.
struct Recognition {
  FrameId frame;  // the frame that the new keyframe was made of
  KeyFrameId keyframe;
  KeyFrameId older;
  int points = 0;  // landmarks that both keyframes show
  int lines = 0;
  // Decimal logarithm of the probability that two different places agree so well by chance.
  double log10_chance = 0;
  // How far the new keyframe moved when the map was corrected [map unit].
  double moved = 0;
  double turned_deg = 0;
  double scale = 1;  // length around the new keyframe after the correction / before
};

// A lost frame that was found in a map.
struct Relocalization {
  FrameId frame;
  KeyFrameId keyframe;  // the keyframe from which the place was found
  int points = 0;       // inliers of the frame's pose
  int lines = 0;
};

// Two maps that became one.
struct MapJoin {
  Recognition place;
  MapId kept;
  MapId gone;
};

// The events that changed maps at large, each kind in the order of time.
struct MapEvents {
  std::vector<Recognition> loops;
  std::vector<MapJoin> joins;
  std::vector<Relocalization> relocalizations;

  bool empty() const { return loops.empty() && joins.empty() && relocalizations.empty(); }
};

// How many events of each kind somebody knows already.
struct MapEventCounts {
  std::size_t loops = 0;
  std::size_t joins = 0;
  std::size_t relocalizations = 0;
};

// Returns the events of one kind behind the first `known`; they are known from then on.
template <class Event>
std::vector<Event> TakeNew(const std::vector<Event>& all, std::size_t& known) {
  std::vector<Event> fresh(all.begin() + static_cast<std::ptrdiff_t>(known), all.end());
  known = all.size();
  return fresh;
}

}  // namespace plumbline
