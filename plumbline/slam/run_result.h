// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/inertial/gyroscope.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/mapping/mapped_line.h"
#include "plumbline/slam/frame_log.h"
#include "plumbline/slam/map_events.h"
#include "plumbline/slam/options.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace plumbline {

// What a run did with the gyroscope of its inertial sensor, and found out about it (Gyroscope).
struct InertialResult {
  std::int64_t turns = 0;         // turns between frames that both camera and gyroscope measured
  std::int64_t contradicted = 0;  // those of them while the sensor was put aside
  GyroscopeErrors errors = GyroscopeErrors::Zero();  // what the calibration lacks
  GyroscopeErrors sigmas = GyroscopeErrors::Zero();  // deviations of the errors
};

// Returns the pose world_from_camera of the left camera as delivered (before rectification), from
// that of the rectified one.
Rigid3 DeliveredPose(const Rigid3& rectified_cam_from_world,
                     const Eigen::Quaterniond& rectified_from_left);

// Result of a run, returned by System::Finish and Pipeline::Finish. Independent of the system.
class RunResult {
 public:
  SlamOptions options;
  RectifiedCamera camera;  // rectified camera of all frames
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
  FrameLog frames;  // records of all frames
  Atlas atlas;
  // Context of the maps, for SaveAtlas. The last session is this run, unless `read_only`. Its id is
  // a hash of the first frame's features and stamp, the rig and the options, so that the same input
  // is the same session wherever it is stored. The path of the input is not part of it.
  AtlasContext context;
  bool read_only = false;                  // maps were loaded and did not change
  KeyFrameId first_keyframe{0};            // first id of this run's own keyframes
  MapEvents events;                        // loops, merges and relocalizations, each kind in order
  std::optional<InertialResult> inertial;  // nullopt without a sensor
  AdjustedLines adjusted_lines;  // lines in local bundle adjustment, summed over all windows
  // Numbers of steps not told by the times of frames: "cut_lines", lines whose cut piece was used
  // for the pose of a frame (CuttingOptions); "start_...", steps of monocular initialization.
  std::map<std::string, std::int64_t> step_counts;

  // Returns the map in which most frames have a pose, of two the one with the smaller id; nullopt
  // if no frame has a pose.
  std::optional<MapId> MainMap() const;
  // Returns the poses of the camera as delivered after all corrections, in order of time. Throws
  // InputError if the atlas has no such map.
  Trajectory FinalTrajectory(MapId map) const;
  // Returns the poses of this run's keyframes alone; otherwise like FinalTrajectory.
  Trajectory KeyFrameTrajectory(MapId map) const;
  // Returns each pose as first reported. `map` may have been merged with another one since; a map
  // without poses gives none.
  Trajectory CausalTrajectory(MapId map) const;
  // Returns the covariances of the poses of CausalTrajectory, as far as they are known
  // (FrameRecord::causal_covariance).
  std::vector<StampedCovariance> CausalCovariances(MapId map) const;
  // Returns the lines of a map accurate enough for output, in its world (MakeLineMap). They are
  // made at the first call, until `stop`, and cached. Throws InputError if the atlas has no such
  // map. Not thread-safe.
  const std::vector<MappedLine>& LineMap(MapId map, const StopCheck& stop = {}) const;

 private:
  const Map& MapOf(MapId id) const;

  mutable std::map<MapId, std::vector<MappedLine>> line_maps_;  // line maps made so far
};

}  // namespace plumbline
