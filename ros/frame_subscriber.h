// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame_pairs.h"
#include "node_log.h"
#include "node_parameters.h"
#include "sensor_messages.h"
#include "transport.h"
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace plumbline::ros_node {

// The images of one instant. `second`: the right image or the depth image.
struct FrameImages {
  TopicImage left;
  std::optional<TopicImage> second;
};

// Subscribes the images of a sensor, and what tells of its cameras.
//
//   mono     image, camera_info
//   stereo   left/image, left/camera_info, right/image, right/camera_info
//   rgbd     image, camera_info, depth (registered to image)
//
// and, of all, imu, whose measurements are handed on.
//
// Two images belong together where their stamps are equal (exact), or nearest (approximate).
// Messages that are none of their type are left out, with a line.
class FrameSubscriber {
 public:
  using Take = std::function<void(const FrameImages&)>;

  using TakeInertial = std::function<void(const InertialMessage&)>;

  FrameSubscriber(Transport& transport,
                  NodeLog& log,
                  const NodeParameters& parameters,
                  Take take,
                  TakeInertial take_inertial);

  // What camera_info said of the cameras; nullopt until it has. The second one with stereo alone.
  using Cameras = std::pair<TopicCamera, std::optional<TopicCamera>>;
  std::optional<Cameras> FindCameras() const;
  // The topics of images, and of the cameras where no file tells of them; whether a message that
  // can be used has come.
  const std::map<std::string, bool>& awaited() const { return awaited_; }
  // The resolved name of the first image topic, without the name of a transport of images.
  const std::string& topic() const { return left_.name; }

 private:
  // A topic of images.
  struct ImageTopic {
    std::string name;  // resolved
    std::string type;
    MessageForm form;
  };

  ImageTopic TopicOf(const std::string& name, const std::string& image_transport) const;
  void SubscribeImages(const ImageTopic& topic,
                       std::function<void(const ImageMessage&, Bytes)> use);
  void SubscribeInfo(const std::string& name, std::optional<TopicCamera>& camera);
  void SubscribeInertial(TakeInertial take);

  Transport& transport_;
  NodeLog& log_;
  const NodeParameters& parameters_;
  Take take_;
  ImageTopic left_, second_;
  std::map<std::string, bool> awaited_;
  std::optional<TopicCamera> left_camera_, right_camera_;
  std::optional<FramePairs> pairs_;
};

}  // namespace plumbline::ros_node
