// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <vector>

namespace plumbline {

// A place that was seen again: the keyframe of `frame` shows what an older keyframe showed.
struct Recognition {
  FrameId frame;  // the older map took the new keyframe in when this one was tracked
  KeyFrameId keyframe;
  KeyFrameId older;
  int points = 0;  // landmarks that both show
  int lines = 0;
  double log10_chance = 0;  // of so much agreement between two different places
  double moved = 0;         // how far the new keyframe went when the map was corrected [map unit]
  double turned_deg = 0;
  double scale = 1;  // of lengths around it, after / before

  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.frame, self.keyframe, self.older, self.points, self.lines);
    visit(self.log10_chance, self.moved, self.turned_deg, self.scale);
  }
};

// A lost frame that was found in a map.
struct Relocalization {
  FrameId frame;
  KeyFrameId keyframe;  // that showed the way
  int points = 0;       // inliers of its pose
  int lines = 0;

  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.frame, self.keyframe, self.points, self.lines);
  }
};

// One map became part of another.
struct MapJoin {
  Recognition place;
  MapId kept;
  MapId gone;

  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.place, self.kept, self.gone);
  }
};

// What changed maps at large, in the order of time.
struct MapEvents {
  std::vector<Recognition> loops;
  std::vector<MapJoin> joins;
  std::vector<Relocalization> relocalizations;
};

}  // namespace plumbline
