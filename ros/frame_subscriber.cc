// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_subscriber.h"

#include <algorithm>

namespace plumbline::ros_node {
namespace {

CameraNumbers NumbersOf(const std::string& topic, const sensor_msgs::CameraInfo& info) {
  CameraNumbers numbers;
  numbers.topic = topic;
  numbers.width = info.width;
  numbers.height = info.height;
  numbers.distortion_model = info.distortion_model;
  numbers.d.assign(info.D.begin(), info.D.end());
  std::copy(info.K.begin(), info.K.end(), numbers.k.begin());
  std::copy(info.R.begin(), info.R.end(), numbers.r.begin());
  std::copy(info.P.begin(), info.P.end(), numbers.p.begin());
  numbers.binning_x = info.binning_x;
  numbers.binning_y = info.binning_y;
  numbers.region = {info.roi.x_offset, info.roi.y_offset, info.roi.width, info.roi.height};
  return numbers;
}

}  // namespace

FrameSubscriber::FrameSubscriber(ros::NodeHandle& public_node,
                                 const NodeParameters& parameters,
                                 Take take)
    : parameters_(parameters), take_(std::move(take)) {
  const bool stereo = parameters.IsStereo();
  left_topic_ = public_node.resolveName(stereo ? "left/image" : "image");
  if (parameters.slam.camera.empty()) {
    SubscribeInfo(public_node, stereo ? "left/camera_info" : "camera_info", left_camera_);
    if (stereo) SubscribeInfo(public_node, "right/camera_info", right_camera_);
  }
  if (!parameters.IsMono()) {
    second_topic_ = public_node.resolveName(stereo ? "right/image" : "depth");
    SubscribePair(public_node);
    return;
  }
  const boost::function<void(const sensor_msgs::ImageConstPtr&)> take_one =
      [this](const sensor_msgs::ImageConstPtr& image) {
        take_({image, nullptr});
      };
  subscribers_.push_back(public_node.subscribe<sensor_msgs::Image>(
      left_topic_, static_cast<std::uint32_t>(parameters.queue_size), take_one));
}

void FrameSubscriber::SubscribePair(ros::NodeHandle& node) {
  const auto queue = static_cast<std::uint32_t>(parameters_.queue_size);
  left_.subscribe(node, left_topic_, queue);
  second_.subscribe(node, second_topic_, queue);
  if (parameters_.approximate_sync) {
    approximate_ = std::make_unique<message_filters::Synchronizer<Approximate>>(
        Approximate(queue), left_, second_);
    approximate_->registerCallback(&FrameSubscriber::TakePair, this);
  } else {
    exact_ = std::make_unique<message_filters::Synchronizer<Exact>>(Exact(queue), left_, second_);
    exact_->registerCallback(&FrameSubscriber::TakePair, this);
  }
}

void FrameSubscriber::SubscribeInfo(ros::NodeHandle& node,
                                    const std::string& topic,
                                    std::optional<CameraNumbers>& out) {
  const std::string name = node.resolveName(topic);
  const boost::function<void(const sensor_msgs::CameraInfoConstPtr&)> keep =
      [name, &out](const sensor_msgs::CameraInfoConstPtr& info) { out = NumbersOf(name, *info); };
  subscribers_.push_back(node.subscribe<sensor_msgs::CameraInfo>(name, 1, keep));
}

void FrameSubscriber::TakePair(const sensor_msgs::ImageConstPtr& left,
                               const sensor_msgs::ImageConstPtr& second) {
  take_({left, second});
}

std::optional<FrameSubscriber::Cameras> FrameSubscriber::FindCameras() const {
  if (!left_camera_ || (parameters_.IsStereo() && !right_camera_)) return std::nullopt;
  return Cameras{*left_camera_, right_camera_};
}

}  // namespace plumbline::ros_node
