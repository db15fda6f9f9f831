// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"

#include <vector>

namespace plumbline {

// The well observed landmarks that a keyframe showed when tracking made it, by feature: what later
// frames show of them tells how far the camera has moved on. Those that mapping finds besides are
// not among them, so that the answer is the same before and after mapping has got to the keyframe.
class KeyFrameTracks {
 public:
  KeyFrameTracks() = default;

  // Those landmarks that `views` keyframes show, the new one included. `snapshot` is what the frame
  // was tracked against.
  KeyFrameTracks(KeyFrameId keyframe, const Frame& frame, const MapSnapshot& snapshot, int views);

  KeyFrameId keyframe() const { return keyframe_; }
  bool empty() const { return points_.empty() && lines_.empty(); }

  struct Count {
    int shown = 0;   // by the keyframe
    int shared = 0;  // of these, by the frame, too
  };
  // Where the snapshot is taken around the keyframe, its features show the landmarks as they are
  // called there; those that the map has given up do not count.
  Count CountShared(const Frame& frame, const MapSnapshot& snapshot) const;

  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.keyframe_, self.points_, self.lines_);
  }

 private:
  // By feature of the keyframe: the landmark, as it was called then; invalid for others.
  KeyFrameId keyframe_;
  std::vector<PointId> points_;
  std::vector<LineId> lines_;
};

}  // namespace plumbline
