// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/trajectory_error.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/dataset.h"
#include "plumbline/report/run_events.h"
#include "plumbline/slam/system.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// One map and the frames that were tracked in it, for display.
struct MapScene {
  MapId id;
  std::vector<std::size_t> frames;           // indices into System::frames(), one for each pose
  std::vector<Rigid3> poses;                 // world_from_camera, camera as delivered
  std::vector<std::size_t> keyframe_frames;  // the same indices for the keyframes that were kept
  std::vector<Rigid3> keyframe_poses;
  // Keyframes in the map, those of earlier runs included.
  std::size_t keyframe_count = 0;
  // Points in the map, and lines in its line map (System::LineMap).
  std::size_t point_count = 0, line_count = 0;
  std::vector<Eigen::Vector3d> points;  // the points to be shown
  std::vector<Segment3> lines;
  std::optional<TrajectoryError> error;  // nullopt: no ground truth at the times of this map
};

// The results of a run in space. A map that can be compared with ground truth is aligned to it, so
// that all such maps share its world; any other one stays in its own world, the first camera.
struct RunScene {
  std::vector<MapScene> maps;
  std::vector<RunEvent> events;     // loops, joins, relocalizations
  std::optional<std::size_t> main;  // index of the map with most frames
  Trajectory reference;             // ground truth of the camera during the run
  Eigen::Vector3d up = {0, -1, 0};  // an axis of the world or its opposite
  // Place near all others, from which the page measures them: the first one of the main map.
  Eigen::Vector3d origin = {0, 0, 0};
};

// Limits for what is shown; beyond them only every n-th landmark is taken.
struct RunSceneLimits {
  std::size_t points = 120'000;
  std::size_t lines = 30'000;
  std::size_t reference = 8'000;
};

// Returns the maps, their trajectories and the ground truth of a run.
//
// `up` is the axis nearest to the mean upward direction of the cameras. Where that direction is
// between axes (a camera that looks down) it is z for a world of ground truth and -y for the world
// of the first camera.
//
//   cost  O(frames log frames + landmarks)
RunScene MakeRunScene(const System& system,
                      const Dataset& dataset,
                      const RunSceneLimits& limits = {});

}  // namespace plumbline
