// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "node.h"

#include "plumbline/base/error.h"

#include "make_node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline::ros_node {
namespace {

constexpr double kPatience = 5;  // s without a frame

}  // namespace

Node::Node(Transport& transport, const NodeParameters& parameters)
    : parameters_(parameters),
      log_(transport),
      poses_(transport, log_, parameters_),
      maps_(transport),
      slam_(parameters_.slam,
            [this](const FrameOutcome& frame) { poses_.Publish(frame, *base_from_camera_); }),
      frames_(
          transport,
          log_,
          parameters_,
          [this](const FrameImages& images) { Take(images); },
          [this](const InertialMessage& message) { TakeInertial(message); }) {
  if (parameters_.slam.imu != "off" && !slam_.UsesInertial()) {
    log_.Say(Severity::kWarning,
             "imu: no camera file tells the place of the sensor; its measurements are not used");
  }
  if (parameters_.load || parameters_.localize) {
    Warn(slam_.Load(parameters_.map_file, parameters_.localize));
  }
  OfferServices(transport);
  TellTopics(transport);
  transport.Repeat(parameters_.map_period, [this] { PublishMap(); });
}

Node::~Node() {
  slam_.Reset();  // its threads count
  if (measurements_ > 0) {
    log_.Say(Severity::kInfo, fmt::format("{} inertial measurements came", measurements_));
  }
  if (frames_fed_ == 0) return;
  log_.Say(Severity::kInfo,
           fmt::format("{} frames came, {} have a pose, {} were left out for want of time",
                       frames_fed_,
                       poses_.published(),
                       poses_.skipped()));
}

void Node::OfferServices(Transport& transport) {
  transport.OfferTrigger("~/save_map", [this] { return slam_.Save(MapFile()); });
  transport.OfferTrigger("~/load_map", [this] { return LoadMaps(false); });
  transport.OfferTrigger("~/localize", [this] { return LoadMaps(true); });
  transport.OfferTrigger("~/reset", [this] {
    slam_.Reset();
    poses_.StartAnew();
    return std::string("the maps are gone; another one begins with the next frame");
  });
}

void Node::Warn(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) log_.Say(Severity::kWarning, remark);
}

void Node::Take(const FrameImages& images) {
  try {
    if (!GetReady(images.left.message)) return;
    newest_stamp_ns_ = images.left.message.stamp_ns;
    const auto jumped = slam_.Feed(images.left, images.second ? &*images.second : nullptr);
    map_is_new_ = true;
    ++frames_fed_;
    if (!jumped) return;
    log_.Say(Severity::kWarning,
             fmt::format("stamps jump back by {:.3f} s; the camera is looked for in the map, or "
                         "another map begins",
                         *jumped));
  } catch (const InputError& error) {
    log_.Throttled(Severity::kError, fmt::format("a frame is left out: {}", error.what()));
  }
}

void Node::TakeInertial(const InertialMessage& message) {
  if (++measurements_ == 1 && !slam_.UsesInertial()) {
    log_.Say(Severity::kInfo, "inertial measurements come, and are not used (parameter imu)");
  }
  if (!slam_.UsesInertial()) return;
  const auto sample = SampleOf(message);
  if (!sample) {
    log_.Throttled(Severity::kWarning,
                   "imu: a measurement is left out: expected a stamp and rates in rad/s");
    return;
  }
  try {
    slam_.AddInertial(*sample);
  } catch (const InputError& error) {
    log_.Throttled(Severity::kError, fmt::format("a frame is left out: {}", error.what()));
  }
}

bool Node::GetReady(const ImageMessage& image) {
  if (!slam_.IsCalibrated()) {
    const auto cameras = frames_.FindCameras();
    if (!cameras) {
      log_.Throttled(
          Severity::kWarning,
          "images come but no camera_info, which frames wait for; or give the parameter camera");
      return false;
    }
    slam_.SetCameras(cameras->first, cameras->second, frames_.topic());
  }
  if (!base_from_camera_) base_from_camera_ = poses_.FindMounting(image.frame);
  return base_from_camera_.has_value();
}

void Node::PublishMap() {
  if (!slam_.HasFrames() || !map_is_new_ || !maps_.IsWanted()) return;
  map_is_new_ = false;
  const MessageHeader header{newest_stamp_ns_, parameters_.map_frame};
  slam_.ViewMap(
      [this, header](const MapView& map) { maps_.Publish(map, *base_from_camera_, header); });
}

void Node::TellTopics(Transport& transport) {
  std::vector<std::string> topics;
  for (const auto& [topic, came] : frames_.awaited()) topics.push_back(topic);
  log_.Say(Severity::kInfo, fmt::format("waits for frames of {}", fmt::join(topics, ", ")));
  transport.After(kPatience, [this, &transport] { TellSilence(transport); });
}

void Node::TellSilence(const Transport& transport) {
  if (frames_fed_ > 0) return;
  std::vector<std::string> missing;
  for (const auto& [topic, came] : frames_.awaited()) {
    if (came) continue;
    missing.push_back(topic + (transport.HasPublisher(topic) ? " has no message that can be used"
                                                             : " has no publisher"));
  }
  // One camera has frames then, and the log says what is wrong with them.
  if (missing.empty() && parameters_.IsMono()) return;
  if (missing.empty()) missing.emplace_back("no two images have fitting stamps (parameter sync)");
  log_.Say(Severity::kWarning,
           fmt::format("no frame in {:g} s: {}", kPatience, fmt::join(missing, ", ")));
}

const std::string& Node::MapFile() const {
  if (parameters_.map_file.empty()) throw InputError("map_file: expected a file, found none");
  return parameters_.map_file;
}

std::string Node::LoadMaps(bool localize) {
  Warn(slam_.Load(MapFile(), localize));
  poses_.StartAnew();
  return MapFile() + (localize ? ": the camera is looked for, and nothing is changed"
                               : ": the camera is looked for, and the map goes on");
}

std::shared_ptr<void> MakeNode(Transport& transport,
                               const Parameters& parameters,
                               const ParameterNames& names) {
  return std::make_shared<Node>(transport, ReadParameters(parameters, names));
}

}  // namespace plumbline::ros_node
