// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "live_slam.h"
#include "node_parameters.h"
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace plumbline::ros_node {

// The messages of one instant. `second`: the right image or the depth image.
struct ImageMessages {
  sensor_msgs::ImageConstPtr left, second;
};

// Subscribes the images of a sensor, and what tells of its cameras.
//
//   mono     image, camera_info
//   stereo   left/image, left/camera_info, right/image, right/camera_info
//   rgbd     image, camera_info, depth (registered to image)
//
// Two images belong together where their stamps are equal (exact), or nearest (approximate).
class FrameSubscriber {
 public:
  using Take = std::function<void(const ImageMessages&)>;

  FrameSubscriber(ros::NodeHandle& public_node, const NodeParameters& parameters, Take take);

  // What camera_info said of the cameras; nullopt until it has. The second one with stereo alone.
  using Cameras = std::pair<CameraNumbers, std::optional<CameraNumbers>>;
  std::optional<Cameras> FindCameras() const;
  // The resolved names of the topics, the first one's first.
  const std::string& topic() const { return left_topic_; }
  const std::string& second_topic() const { return second_topic_; }

 private:
  using Exact = message_filters::sync_policies::ExactTime<sensor_msgs::Image, sensor_msgs::Image>;
  using Approximate =
      message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::Image>;

  void SubscribePair(ros::NodeHandle& node);
  void SubscribeInfo(ros::NodeHandle& node,
                     const std::string& topic,
                     std::optional<CameraNumbers>& out);
  void TakePair(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& second);

  const NodeParameters& parameters_;
  Take take_;
  std::string left_topic_, second_topic_;
  std::optional<CameraNumbers> left_camera_, right_camera_;
  std::vector<ros::Subscriber> subscribers_;
  message_filters::Subscriber<sensor_msgs::Image> left_, second_;
  std::unique_ptr<message_filters::Synchronizer<Exact>> exact_;
  std::unique_ptr<message_filters::Synchronizer<Approximate>> approximate_;
};

}  // namespace plumbline::ros_node
