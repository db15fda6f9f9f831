// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>

namespace plumbline::ros_node {

// Between rigid motions and the messages of ROS; the same numbers.
Rigid3 FromTransform(const geometry_msgs::Transform& message);
geometry_msgs::Transform ToTransform(const Rigid3& motion);
geometry_msgs::Pose ToPose(const Rigid3& motion);
geometry_msgs::Point ToPoint(const Eigen::Vector3d& point);

// The camera in a base that looks where it looks: x ahead, y to the left, z up (REP 103) for z
// ahead, x to the right, y down.
Rigid3 ForwardLooking();

}  // namespace plumbline::ros_node
