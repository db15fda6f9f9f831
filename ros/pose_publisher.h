// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "live_slam.h"
#include "node_parameters.h"
#include "odometry_frame.h"
#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

namespace plumbline::ros_node {

// Publishes where the robot is, for each frame with a pose: ~pose (in the map), ~odometry (in
// odom), and to tf the frames of REP 105: map to odom, odom to base. ~state has a word for each
// change: initializing, tracked, lost.
//
// The map's frame is the base at the first keyframe of the map: a level robot has z up.
class PosePublisher {
 public:
  PosePublisher(ros::NodeHandle& own, const NodeParameters& parameters);

  // Where the camera is mounted: looked up in tf by the frame of its images, waited for up to two
  // seconds. nullopt: wait on. Without a transform the base looks where the camera looks, and a
  // warning says so.
  std::optional<Rigid3> FindMounting(const std::string& camera_frame);

  // From the thread that tracks. `stamp`: of the message that the frame came in.
  void Publish(const FrameOutcome& frame, const Rigid3& base_from_camera, const ros::Time& stamp);
  // The next poses have nothing to do with those before: the maps are others.
  void StartAnew() { odometry_.reset(); }

 private:
  void PublishState(const FrameOutcome& frame);
  void PublishTransforms(const BasePose& pose, const ros::Time& stamp);
  std::optional<Rigid3> OdomFromOthers(const ros::Time& stamp) const;

  const NodeParameters& parameters_;
  ros::Publisher pose_, odometry_publisher_, state_;
  std::string state_now_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::optional<ros::WallTime> waiting_since_;
  std::optional<OdometryFrame> odometry_;
};

}  // namespace plumbline::ros_node
