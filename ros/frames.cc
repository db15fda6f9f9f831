// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "frames.h"

namespace plumbline::ros_node {

Rigid3 FromTransform(const geometry_msgs::Transform& message) {
  const auto& r = message.rotation;
  const auto& t = message.translation;
  return {Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized(), {t.x, t.y, t.z}};
}

geometry_msgs::Transform ToTransform(const Rigid3& motion) {
  geometry_msgs::Transform message;
  message.rotation = ToPose(motion).orientation;
  message.translation.x = motion.translation.x();
  message.translation.y = motion.translation.y();
  message.translation.z = motion.translation.z();
  return message;
}

geometry_msgs::Pose ToPose(const Rigid3& motion) {
  geometry_msgs::Pose message;
  message.position = ToPoint(motion.translation);
  message.orientation.x = motion.rotation.x();
  message.orientation.y = motion.rotation.y();
  message.orientation.z = motion.rotation.z();
  message.orientation.w = motion.rotation.w();
  return message;
}

geometry_msgs::Point ToPoint(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

Rigid3 ForwardLooking() {
  Eigen::Matrix3d base_from_camera;
  base_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(base_from_camera), Eigen::Vector3d::Zero()};
}

}  // namespace plumbline::ros_node
