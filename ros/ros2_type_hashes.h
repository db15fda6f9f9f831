// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::ros_node {

// What an endpoint of DDS tells others of its type from ROS 2 Iron on, in USER_DATA (REP 2016):
// "typehash=RIHS01_...;" with the hash of the type's description (REP 2011). `type` as ROS 1 names
// it: "sensor_msgs/Image". Empty for types that the node does not use.
std::string UserDataOfType(const std::string& type);

}  // namespace plumbline::ros_node
