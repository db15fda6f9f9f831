// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame_subscriber.h"
#include "live_slam.h"
#include "map_publisher.h"
#include "node_log.h"
#include "node_parameters.h"
#include "pose_publisher.h"
#include "transport.h"
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace plumbline::ros_node {

// The node: frames from topics into LiveSlam, poses and maps out of it, and services to save, load,
// localize and reset. What it subscribes, publishes and offers: docs/ros.md and docs/ros2.md.
//
// All it hands to the transport is called in one thread.
class Node {
 public:
  // Throws InputError for a map that cannot be loaded.
  Node(Transport& transport, const NodeParameters& parameters);
  // Says how many frames came, and what came of them.
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

 private:
  void Take(const FrameImages& images);
  void TakeInertial(const InertialMessage& message);
  // Whether all that the first frame needs is known by now.
  bool GetReady(const ImageMessage& image);
  void PublishMap();
  // What the node waits for: at the start, and once more if no frame came for a while.
  void TellTopics(Transport& transport);
  void TellSilence(const Transport& transport);
  void OfferServices(Transport& transport);
  const std::string& MapFile() const;
  std::string LoadMaps(bool localize);
  void Warn(const std::vector<std::string>& remarks);

  NodeParameters parameters_;
  NodeLog log_;
  PosePublisher poses_;
  MapPublisher maps_;
  std::optional<Rigid3> base_from_camera_;
  std::int64_t newest_stamp_ns_ = 0;
  std::int64_t frames_fed_ = 0;
  std::int64_t measurements_ = 0;  // of an inertial sensor, used or not
  bool map_is_new_ = false;        // there were frames since the map was published
  LiveSlam slam_;                  // its threads use what is above
  FrameSubscriber frames_;
};

}  // namespace plumbline::ros_node
