// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "odometry_frame.h"

#include "plumbline/geometry/covariance.h"

namespace plumbline::ros_node {

Matrix6d BaseCovariance(const BasePose& pose,
                        const Rigid3& base_from_camera,
                        const Rigid3& world_from_camera,
                        const Matrix6d& of_camera) {
  // The axes of the map are those of the world as the base stands in it (PosePublisher::Publish).
  const Eigen::Quaterniond odom_from_world =
      pose.MapFromOdom().rotation.conjugate() * base_from_camera.rotation;
  const Eigen::Vector3d lever = world_from_camera.rotation * Inverse(base_from_camera).translation;
  return MovedPoseCovariance(of_camera, odom_from_world, lever);
}

const BasePose& OdometryFrame::Next(std::int64_t stamp_ns,
                                    std::int64_t map,
                                    const Rigid3& map_from_base,
                                    bool corrected) {
  constexpr double kLongest = 0.5;  // seconds that a motion is taken to go on
  BasePose pose;
  pose.map_from_base = map_from_base;
  pose.odom_from_base = map_from_base;
  if (last_) {
    // Stamps of a bag that is played anew go back; a device may repeat one.
    const double seconds = 1e-9 * static_cast<double>(stamp_ns - last_stamp_ns_);
    const bool later = seconds > 0;
    Vector6d motion = Vector6d::Zero();  // of the base in its frame before: [rotation, translation]
    if (map == last_map_ && !corrected && !correcting_) {
      motion = LogSe3(Inverse(last_->map_from_base) * map_from_base);
    } else if (later && seconds <= kLongest) {
      motion << seconds * last_->angular, seconds * last_->linear;
    }
    pose.odom_from_base = last_->odom_from_base * ExpSe3(motion);
    pose.odom_from_base.rotation.normalize();
    if (later) {
      pose.angular = motion.head<3>() / seconds;
      pose.linear = motion.tail<3>() / seconds;
    }
  }
  last_ = pose;
  last_stamp_ns_ = stamp_ns;
  last_map_ = map;
  correcting_ = corrected;
  return *last_;
}

}  // namespace plumbline::ros_node
