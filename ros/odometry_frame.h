// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <optional>

namespace plumbline::ros_node {

// Where the robot is in the map, and in the frame `odom` of REP 105, in which it never jumps.
struct BasePose {
  Rigid3 map_from_base;
  Rigid3 odom_from_base;
  // Of the base, in its own frame, since the pose before: m/s and rad/s; zero where not known.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();

  Rigid3 MapFromOdom() const { return map_from_base * Inverse(odom_from_base); }
};

// Returns the covariance of the base relative to the map, as nav_msgs/Odometry has it: of x, y, z
// and the rotation about x, y, z, along the axes of `odom`.
//
//   pose         of the base
//   of_camera    of the camera relative to the map, along the axes of the world in which
//                world_from_camera is
Matrix6d BaseCovariance(const BasePose& pose,
                        const Rigid3& base_from_camera,
                        const Rigid3& world_from_camera,
                        const Matrix6d& of_camera);

// Follows the motion of a robot from its poses in maps that are corrected now and then.
//
// Between two poses in one map the robot moves in `odom` as it does in the map. Where the map was
// corrected between them (a loop was closed, the camera was found again) or another map begins, the
// difference of the poses is no motion: then it goes on as fast as before, or, after more than half
// a second, not at all. The first pose in `odom` is that in the map.
class OdometryFrame {
 public:
  // The next pose, with the id of its map. `corrected`: something corrected the map at large since
  // the pose before.
  const BasePose& Next(std::int64_t stamp_ns,
                       std::int64_t map,
                       const Rigid3& map_from_base,
                       bool corrected);

 private:
  std::optional<BasePose> last_;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t last_map_ = -1;
  bool correcting_ = false;  // a correction may show one frame after it is known
};

}  // namespace plumbline::ros_node
