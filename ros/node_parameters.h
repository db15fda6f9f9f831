// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "live_slam.h"
#include "transport.h"
#include <string>

namespace plumbline::ros_node {

// The parameters of the node; docs/ros.md says what they are.
struct NodeParameters {
  LiveSlamSettings slam;  // sensor, camera, rectified, config, options, imu
  std::string image_transport = "raw", depth_transport = "raw";
  bool approximate_sync = false;
  int queue_size = 5;
  std::string map_file;  // empty: none
  bool load = false;
  bool localize = false;
  std::string map_frame = "map", odom_frame = "odom", base_frame = "base_link";
  bool publish_tf = true;
  bool publish_odom_tf = true;  // false: somebody else publishes odom to base
  double map_period = 1;        // s

  bool IsStereo() const { return slam.sensor == "stereo"; }
  bool IsMono() const { return slam.sensor == "mono"; }
};

// Reads all of them. Throws InputError for a parameter of another type, a value that makes no sense
// and a name that is none, with what was expected and found.
NodeParameters ReadParameters(const Parameters& parameters, const ParameterNames& names);

}  // namespace plumbline::ros_node
