// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/run_events.h"
#include "plumbline/report/trajectory_error.h"
#include "plumbline/slam/run_result.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// One map and its tracked frames, for display.
struct MapScene {
  MapId id;
  std::vector<std::size_t> frames;           // indices into RunResult::frames, one for each pose
  std::vector<Rigid3> poses;                 // world_from_camera, camera as delivered
  std::vector<std::size_t> keyframe_frames;  // the same indices for the kept keyframes
  std::vector<Rigid3> keyframe_poses;
  // Number of keyframes in the map, including those of earlier runs.
  std::size_t keyframe_count = 0;
  // Numbers of points in the map, and of lines in its line map (RunResult::LineMap).
  std::size_t point_count = 0, line_count = 0;
  std::vector<Eigen::Vector3d> points;  // displayed points
  std::vector<Segment3> lines;
  std::optional<TrajectoryError> error;  // nullopt: no ground truth at the times of this map
};

// Spatial results of a run. Maps that can be compared with ground truth are aligned to it and share
// its world; any other one stays in its own world, the first camera.
struct RunScene {
  std::vector<MapScene> maps;
  std::vector<RunEvent> events;     // loops, joins, relocalizations
  std::optional<std::size_t> main;  // index of the map with most frames
  Trajectory reference;             // ground truth of the camera during the run
  Eigen::Vector3d up = {0, -1, 0};  // an axis of the world or its opposite
  // Reference point of the page's coordinates, near all others: the first one of the main map.
  Eigen::Vector3d origin = {0, 0, 0};
};

// Limits of the display; beyond them only every n-th landmark is used.
struct RunSceneLimits {
  std::size_t points = 120'000;
  std::size_t lines = 30'000;
  std::size_t reference = 8'000;
};

// Returns the maps, their trajectories and the ground truth of a run.
//
// `up` is the axis nearest to the mean upward direction of the cameras. If that direction is
// between axes (a camera that looks down) it is z for a world of ground truth and -y for the world
// of the first camera.
//
//   cost  O(frames log frames + landmarks)
RunScene MakeRunScene(const RunResult& result,
                      const Dataset& dataset,
                      const RunSceneLimits& limits = {});

}  // namespace plumbline
