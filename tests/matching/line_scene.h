// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"

#include "tests/support/synthetic_world.h"

namespace plumbline::testing {

// One stereo line, seen from the origin, with its features.
struct LineScene {
  SyntheticWorld world;
  Segment3 segment;
  Rigid3 cam_from_world;
  SyntheticFrame sensed;
  Frame frame;
  PluckerLine line;

  LineScene(const Segment3& s, const SensorModel& sensor, const Rigid3& pose = {})
      : segment(s), cam_from_world(pose) {
    world.lines.push_back({s, Descriptor{1, 2, 3, 4}});
    Rng rng(3);
    sensed = Sense(world, pose, sensor, rng);
    frame = MakeFrame(FrameId{0}, pose, sensed);
    line = LineThroughPoints(s.start, s.end);
  }
};

inline const SensorModel kExact{.noise = 0, .flipped_bits = 0, .missed = 0};
inline const Segment3 kSlanted{{-0.5, -0.8, 4}, {0.6, 0.9, 5}};
inline const Segment3 kLevel{{-1, 0.4, 4}, {1, 0.4, 4}};

}  // namespace plumbline::testing
