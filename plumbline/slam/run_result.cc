// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/run_result.h"

#include "plumbline/base/error.h"
#include "plumbline/mapping/line_map.h"
#include "plumbline/matching/projection_search.h"

#include <fmt/format.h>

namespace plumbline {

Rigid3 DeliveredPose(const Rigid3& rectified_cam_from_world,
                     const Eigen::Quaterniond& rectified_from_left) {
  const Rigid3 rectified_from_delivered{rectified_from_left, Eigen::Vector3d::Zero()};
  return Inverse(rectified_cam_from_world) * rectified_from_delivered;
}

std::optional<MapId> RunResult::MainMap() const {
  std::map<MapId, int> counts;
  for (const FrameRecord& record : frames) {
    if (record.status == FrameStatus::kTracked) ++counts[atlas.Current(record.map)];
  }
  std::optional<MapId> main;
  for (const auto& [id, count] : counts) {
    if (!main || count > counts[*main]) main = id;
  }
  return main;
}

Trajectory RunResult::FinalTrajectory(MapId map) const {
  Trajectory trajectory;
  const Map& owner = MapOf(map);
  for (const FrameRecord& record : frames) {
    if (record.status != FrameStatus::kTracked || atlas.Current(record.map) != map) continue;
    if (!owner.Knows(record.reference)) continue;  // Finish failed before it lost the frame
    const Rigid3 cam_from_world =
        ComposePose(owner.PlaceOf(record.reference), record.from_reference);
    trajectory.push_back({record.stamp_ns, DeliveredPose(cam_from_world, rectified_from_left)});
  }
  return trajectory;
}

Trajectory RunResult::KeyFrameTrajectory(MapId map) const {
  Trajectory trajectory;
  for (const auto& [id, keyframe] : MapOf(map).keyframes()) {
    if (id < first_keyframe) continue;
    trajectory.push_back({keyframe.frame.stamp_ns,
                          DeliveredPose(keyframe.frame.cam_from_world, rectified_from_left)});
  }
  return trajectory;
}

Trajectory RunResult::CausalTrajectory(MapId map) const {
  Trajectory trajectory;
  for (const FrameRecord& record : frames) {
    if (record.causal_world_from_camera && record.map == map) {
      trajectory.push_back({record.stamp_ns, *record.causal_world_from_camera});
    }
  }
  return trajectory;
}

std::vector<StampedCovariance> RunResult::CausalCovariances(MapId map) const {
  std::vector<StampedCovariance> covariances;
  for (const FrameRecord& record : frames) {
    if (record.causal_covariance && record.map == map) {
      covariances.push_back({record.stamp_ns, *record.causal_covariance});
    }
  }
  return covariances;
}

const std::vector<MappedLine>& RunResult::LineMap(MapId map, const StopCheck& stop) const {
  const auto made = line_maps_.find(map);
  if (made != line_maps_.end()) return made->second;
  const CameraAndPyramid imaging{camera, options.features.orb.scale_factor};
  return line_maps_[map] = MakeLineMap(MapOf(map), imaging, options.mapping.line_map, stop);
}

const Map& RunResult::MapOf(MapId id) const {
  if (const Map* map = atlas.Find(id)) return *map;
  throw InputError(
      fmt::format("map {}: expected one of the {} maps of the run", id.value, atlas.maps().size()));
}

}  // namespace plumbline
