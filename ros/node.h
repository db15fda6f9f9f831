// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame_subscriber.h"
#include "live_slam.h"
#include "map_publisher.h"
#include "node_parameters.h"
#include "pose_publisher.h"
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/time.h>
#include <ros/wall_timer.h>
#include <std_srvs/Trigger.h>

namespace plumbline::ros_node {

// The node: frames from topics into LiveSlam, poses and maps out of it, and services to save, load,
// localize and reset. What it subscribes, publishes and offers: docs/ros.md.
//
// Callbacks are called in one thread (ros::spin).
class Node {
 public:
  // Throws InputError for wrong parameters and a map that cannot be loaded.
  Node(ros::NodeHandle public_node, ros::NodeHandle own);

 private:
  using Trigger = std_srvs::Trigger;

  void Take(const ImageMessages& messages);
  // Whether all that the first frame needs is known by now.
  bool GetReady(const sensor_msgs::Image& image);
  void PublishMap();

  bool Save(Trigger::Request& request, Trigger::Response& response);
  bool Load(Trigger::Request& request, Trigger::Response& response);
  bool Localize(Trigger::Request& request, Trigger::Response& response);
  bool Reset(Trigger::Request& request, Trigger::Response& response);
  const std::string& MapFile() const;
  std::string LoadMaps(bool localize);

  NodeParameters parameters_;
  PosePublisher poses_;
  MapPublisher maps_;
  std::optional<Rigid3> base_from_camera_;
  ros::Time newest_stamp_;
  bool map_is_new_ = false;  // there were frames since the map was published
  LiveSlam slam_;            // its threads use what is above
  FrameSubscriber frames_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer map_timer_;
};

}  // namespace plumbline::ros_node
