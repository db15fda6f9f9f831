// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "node.h"

#include "plumbline/base/error.h"

#include <functional>
#include <utility>

#include <ros/console.h>

namespace plumbline::ros_node {
namespace {

ros::Time TimeOf(std::int64_t stamp_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  return time;
}

RawImage RawOf(const std::string& topic, const sensor_msgs::Image& message) {
  RawImage image;
  image.topic = topic;
  image.encoding = message.encoding;
  image.width = message.width;
  image.height = message.height;
  image.step = message.step;
  image.big_endian = message.is_bigendian != 0;
  image.data = message.data.data();
  image.size = message.data.size();
  return image;
}

// What `work` returns is the message of success, what it throws that of a failure.
bool Answer(const std::function<std::string()>& work, std_srvs::Trigger::Response& response) {
  try {
    response.message = work();
    response.success = 1;
    ROS_INFO("%s", response.message.c_str());
  } catch (const InputError& error) {
    response.message = error.what();
    response.success = 0;
    ROS_ERROR("%s", response.message.c_str());
  }
  return true;
}

void Warn(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) ROS_WARN("%s", remark.c_str());
}

}  // namespace

Node::Node(ros::NodeHandle public_node, ros::NodeHandle own)
    : parameters_(ReadParameters(own)),
      poses_(own, parameters_),
      maps_(own, parameters_),
      slam_(parameters_.slam,
            [this](const FrameOutcome& frame) {
              poses_.Publish(frame, *base_from_camera_, TimeOf(frame.stamp_ns));
            }),
      frames_(public_node, parameters_, [this](const ImageMessages& messages) { Take(messages); }) {
  if (parameters_.load || parameters_.localize) {
    Warn(slam_.Load(parameters_.map_file, parameters_.localize));
  }
  services_.push_back(own.advertiseService("save_map", &Node::Save, this));
  services_.push_back(own.advertiseService("load_map", &Node::Load, this));
  services_.push_back(own.advertiseService("localize", &Node::Localize, this));
  services_.push_back(own.advertiseService("reset", &Node::Reset, this));
  map_timer_ = own.createWallTimer(ros::WallDuration(parameters_.map_period),
                                   boost::function<void(const ros::WallTimerEvent&)>(
                                       [this](const ros::WallTimerEvent&) { PublishMap(); }));
}

void Node::Take(const ImageMessages& messages) {
  try {
    if (!GetReady(*messages.left)) return;
    const RawImage left = RawOf(frames_.topic(), *messages.left);
    std::optional<RawImage> second;
    if (messages.second) second = RawOf(frames_.second_topic(), *messages.second);
    newest_stamp_ = messages.left->header.stamp;
    const auto jumped = slam_.Feed(
        static_cast<std::int64_t>(newest_stamp_.toNSec()), left, second ? &*second : nullptr);
    map_is_new_ = true;
    if (!jumped) return;
    ROS_WARN(
        "stamps jump back by %.3f s; the camera is looked for in the map, or another map begins",
        *jumped);
  } catch (const InputError& error) {
    ROS_ERROR_THROTTLE(5, "a frame is left out: %s", error.what());
  }
}

bool Node::GetReady(const sensor_msgs::Image& image) {
  if (!slam_.IsCalibrated()) {
    const auto cameras = frames_.FindCameras();
    if (!cameras) {
      ROS_WARN_THROTTLE(5,
                        "images come but no camera_info, which frames wait for; or give ~camera");
      return false;
    }
    slam_.SetCameras(cameras->first, cameras->second, frames_.topic());
  }
  if (!base_from_camera_) base_from_camera_ = poses_.FindMounting(image.header.frame_id);
  return base_from_camera_.has_value();
}

void Node::PublishMap() {
  if (!slam_.HasFrames() || !map_is_new_ || !maps_.IsWanted()) return;
  map_is_new_ = false;
  slam_.ViewMap([this, stamp = newest_stamp_](const MapView& map) {
    maps_.Publish(map, *base_from_camera_, stamp);
  });
}

bool Node::Save(Trigger::Request&, Trigger::Response& response) {
  return Answer([this] { return slam_.Save(MapFile()); }, response);
}

bool Node::Load(Trigger::Request&, Trigger::Response& response) {
  return Answer([this] { return LoadMaps(false); }, response);
}

bool Node::Localize(Trigger::Request&, Trigger::Response& response) {
  return Answer([this] { return LoadMaps(true); }, response);
}

bool Node::Reset(Trigger::Request&, Trigger::Response& response) {
  return Answer(
      [this] {
        slam_.Reset();
        poses_.StartAnew();
        return std::string("the maps are gone; another one begins with the next frame");
      },
      response);
}

const std::string& Node::MapFile() const {
  if (parameters_.map_file.empty()) throw InputError("~map_file: expected a file, found none");
  return parameters_.map_file;
}

std::string Node::LoadMaps(bool localize) {
  Warn(slam_.Load(MapFile(), localize));
  poses_.StartAnew();
  return MapFile() + (localize ? ": the camera is looked for, and nothing is changed"
                               : ": the camera is looked for, and the map goes on");
}

}  // namespace plumbline::ros_node
