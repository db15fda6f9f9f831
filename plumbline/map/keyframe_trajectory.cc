// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/keyframe_trajectory.h"

#include <cstdint>
#include <map>

namespace plumbline {

Trajectory KeyFrameTrajectory(const Map& map, const Eigen::Quaterniond& rectified_from_left) {
  const Rigid3 rectified{rectified_from_left, Eigen::Vector3d::Zero()};
  std::map<std::int64_t, Rigid3> poses;
  for (const auto& [id, keyframe] : map.keyframes()) {
    poses.emplace(keyframe.frame.stamp_ns, Inverse(keyframe.frame.cam_from_world) * rectified);
  }
  Trajectory trajectory;
  for (const auto& [stamp_ns, pose] : poses) trajectory.push_back({stamp_ns, pose});
  return trajectory;
}

}  // namespace plumbline
