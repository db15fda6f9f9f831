// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_subscriber.h"

#include <fmt/format.h>

namespace plumbline::ros_node {
namespace {

constexpr int kInertialQueue = 200;  // measurements: a fifth of a second and more

}  // namespace

FrameSubscriber::FrameSubscriber(Transport& transport,
                                 NodeLog& log,
                                 const NodeParameters& parameters,
                                 Take take,
                                 TakeInertial take_inertial)
    : transport_(transport), log_(log), parameters_(parameters), take_(std::move(take)) {
  const bool stereo = parameters.IsStereo();
  left_ = TopicOf(stereo ? "left/image" : "image", parameters.image_transport);
  if (parameters.slam.camera.empty()) {
    SubscribeInfo(stereo ? "left/camera_info" : "camera_info", left_camera_);
    if (stereo) SubscribeInfo("right/camera_info", right_camera_);
  }
  SubscribeInertial(std::move(take_inertial));
  if (parameters.IsMono()) {
    SubscribeImages(left_, [this](const ImageMessage& image, const Bytes&) {
      take_({{left_.name, image}, std::nullopt});
    });
    return;
  }
  second_ = stereo ? TopicOf("right/image", parameters.image_transport)
                   : TopicOf("depth", parameters.depth_transport);
  pairs_.emplace(parameters.approximate_sync,
                 static_cast<std::size_t>(parameters.queue_size),
                 [this](const Bytes& left, const Bytes& second) {
                   take_({{left_.name, *ParseImage(left_.form, left)},
                          TopicImage{second_.name, *ParseImage(second_.form, second)}});
                 });
  SubscribeImages(left_, [this](const ImageMessage& image, Bytes bytes) {
    pairs_->AddFirst(image.stamp_ns, std::move(bytes));
  });
  SubscribeImages(second_, [this](const ImageMessage& image, Bytes bytes) {
    pairs_->AddSecond(image.stamp_ns, std::move(bytes));
  });
}

FrameSubscriber::ImageTopic FrameSubscriber::TopicOf(const std::string& name,
                                                     const std::string& image_transport) const {
  ImageTopic topic;
  topic.name = transport_.Resolve(name);
  topic.form.encoding = transport_.UsesCdr() ? MessageEncoding::kCdr : MessageEncoding::kRos1;
  topic.type = "sensor_msgs/Image";
  if (image_transport == "raw") return topic;
  topic.form.kind = MessageKind::kCompressedImage;
  topic.type = "sensor_msgs/CompressedImage";
  return topic;
}

void FrameSubscriber::SubscribeImages(const ImageTopic& topic,
                                      std::function<void(const ImageMessage&, Bytes)> use) {
  const bool is_left = &topic == &left_;
  const std::string& image_transport =
      is_left || parameters_.IsStereo() ? parameters_.image_transport : parameters_.depth_transport;
  TopicSettings settings;
  settings.name = image_transport == "raw" ? topic.name : topic.name + "/" + image_transport;
  settings.type = topic.type;
  settings.queue_size = parameters_.queue_size;
  settings.sensor_data = true;
  bool& came = awaited_[settings.name];
  transport_.Subscribe(settings,
                       [this, settings, &topic, &came, use = std::move(use)](Bytes bytes) {
                         const auto image = ParseImage(topic.form, bytes);
                         if (!image) return log_.Refuse(settings, bytes.size());
                         came = true;
                         use(*image, std::move(bytes));  // the image points into the same bytes
                       });
}

void FrameSubscriber::SubscribeInfo(const std::string& name, std::optional<TopicCamera>& camera) {
  TopicSettings settings;
  settings.name = transport_.Resolve(name);
  settings.type = "sensor_msgs/CameraInfo";
  settings.sensor_data = true;
  bool& came = awaited_[settings.name];
  transport_.Subscribe(settings, [this, settings, &camera, &came](const Bytes& bytes) {
    const auto message = ParseRosCalibration(transport_.UsesCdr(), bytes);
    if (!message) return log_.Refuse(settings, bytes.size());
    came = true;
    camera = TopicCamera{settings.name, *message};
  });
}

void FrameSubscriber::SubscribeInertial(TakeInertial take) {
  TopicSettings settings;
  settings.name = transport_.Resolve("imu");
  settings.type = "sensor_msgs/Imu";
  settings.queue_size = kInertialQueue;
  settings.sensor_data = true;
  transport_.Subscribe(settings, [this, settings, take = std::move(take)](const Bytes& bytes) {
    const auto message = ParseRosInertial(transport_.UsesCdr(), bytes);
    if (!message) return log_.Refuse(settings, bytes.size());
    take(*message);
  });
}

std::optional<FrameSubscriber::Cameras> FrameSubscriber::FindCameras() const {
  if (!left_camera_ || (parameters_.IsStereo() && !right_camera_)) return std::nullopt;
  return Cameras{*left_camera_, right_camera_};
}

}  // namespace plumbline::ros_node
