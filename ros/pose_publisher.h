// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "live_slam.h"
#include "node_log.h"
#include "node_parameters.h"
#include "odometry_frame.h"
#include "transform_tree.h"
#include "transport.h"
#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace plumbline::ros_node {

// Publishes where the robot is, for each frame with a pose: ~/pose (in the map), ~/odometry (in
// odom), and to tf the frames of REP 105: map to odom, odom to base. ~/state has a word for each
// change: initializing, tracked, lost.
//
// The map's frame is the base at the first keyframe of the map: a level robot has z up.
class PosePublisher {
 public:
  PosePublisher(Transport& transport, NodeLog& log, const NodeParameters& parameters);

  // Where the camera is mounted: looked up in tf by the frame of its images, waited for up to two
  // seconds. nullopt: wait on. Without a transform the base looks where the camera looks; a warning
  // says so, and /tf_static gets this transform.
  std::optional<Rigid3> FindMounting(const std::string& camera_frame);

  // From the thread that tracks.
  void Publish(const FrameOutcome& frame, const Rigid3& base_from_camera);
  // The next poses have nothing to do with those before: the maps are others.
  void StartAnew() { odometry_.reset(); }
  // Frames so far; not while frames are tracked.
  std::int64_t published() const { return published_; }
  std::int64_t skipped() const { return skipped_; }

 private:
  void ListenTo(const std::string& topic, bool is_static);
  void PublishState(const FrameOutcome& frame);
  void PublishTransforms(const BasePose& pose, std::int64_t stamp_ns);

  Transport& transport_;
  NodeLog& log_;
  const NodeParameters& parameters_;
  std::unique_ptr<Publication> pose_, odometry_publication_, state_, tf_, tf_static_;
  std::string state_now_;
  std::int64_t published_ = 0, skipped_ = 0;
  TransformTree transforms_;
  std::optional<std::chrono::steady_clock::time_point> waiting_since_;
  std::optional<OdometryFrame> odometry_;
};

}  // namespace plumbline::ros_node
