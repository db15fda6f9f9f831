// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"

#include "tests/support/synthetic_world.h"
#include <cstdint>
#include <map>
#include <vector>

namespace plumbline {

// Scale of the map in the tests: metres of the synthetic world per map unit.
inline constexpr double kMapUnit = 6;

inline const SensorModel kOneCamera{.depth = false, .noise = 0.5};

// The world for a single camera.
inline SyntheticWorld MakeMonocularWorld(std::size_t points, std::size_t lines) {
  SyntheticWorld world = MakeSyntheticWorld(points, lines);
  world.camera.baseline = 0;
  return world;
}

// Converts a pose of the synthetic world to map units.
inline Rigid3 InMapUnit(const Rigid3& cam_from_world) {
  return {cam_from_world.rotation, cam_from_world.translation / kMapUnit};
}

// Returns the input of an initializer at a frame of the path, for a single camera.
inline InitializationFrame MonocularFrame(const SyntheticWorld& world,
                                          int path_frame,
                                          SyntheticFrame* sensed = nullptr) {
  Rng rng(1, "monocular_frame", static_cast<std::uint64_t>(path_frame));
  SyntheticFrame frame = Sense(world, PoseOnPath(path_frame), kOneCamera, rng);
  if (sensed != nullptr) *sensed = frame;
  return {FrameId{path_frame}, 50'000'000LL * path_frame, frame.indexed, nullptr};
}

// The true map of some frames of the path, the first of which is 0, of a single camera: landmarks
// with two observations or more, in units of kMapUnit metres.
inline InitialMap InitialMapOf(const SyntheticWorld& world, const std::vector<int>& path_frames) {
  InitialMap map;
  std::map<std::size_t, std::vector<InitialObservation>> points, lines;
  for (const int path_frame : path_frames) {
    const int view = static_cast<int>(map.views.size());
    SyntheticFrame sensed;
    map.views.push_back({MonocularFrame(world, path_frame, &sensed), {}});
    map.views.back().cam_from_world = InMapUnit(PoseOnPath(path_frame));
    for (std::size_t i = 0; i < sensed.point_truth.size(); ++i) {
      points[sensed.point_truth[i]].push_back({view, static_cast<int>(i)});
    }
    for (std::size_t i = 0; i < sensed.line_truth.size(); ++i) {
      lines[sensed.line_truth[i]].push_back({view, static_cast<int>(i)});
    }
  }
  for (const auto& [index, seen] : points) {
    if (seen.size() >= 2) map.points.push_back({world.points[index].position / kMapUnit, seen});
  }
  for (const auto& [index, seen] : lines) {
    if (seen.size() < 2) continue;
    const Segment3& segment = world.lines[index].segment;
    const Segment3 scaled{segment.start / kMapUnit, segment.end / kMapUnit};
    map.lines.push_back({LineThroughPoints(scaled.start, scaled.end), scaled, seen});
  }
  return map;
}

}  // namespace plumbline
