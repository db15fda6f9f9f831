// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/recordings/image_message.h"

#include "ros/frame_subscriber.h"
#include "ros/inertial_queue.h"
#include "ros/transform_tree.h"
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace {

using namespace plumbline;
using namespace plumbline::ros_node;

// Hands messages over as if they came from the network.
class InventedTransport : public Transport {
 public:
  explicit InventedTransport(bool cdr) : cdr_(cdr) {}

  bool UsesCdr() const override { return cdr_; }
  std::string Resolve(const std::string& name) const override { return "/" + name; }
  void Subscribe(const TopicSettings& topic, Receive receive) override {
    receivers_.emplace(topic.name, std::move(receive));
  }
  void Repeat(double, std::function<void()>) override {}
  void After(double, std::function<void()>) override {}
  bool HasPublisher(const std::string&) const override { return false; }
  void OfferTrigger(const std::string&, std::function<std::string()>) override {}
  std::unique_ptr<Publication> Advertise(const TopicSettings&) override { return nullptr; }
  void Log(Severity, const std::string& line) override {
    if (line.find('\n') != std::string::npos) throw std::logic_error("more than one line");
  }

  void Send(const std::string& topic, const Bytes& message) const {
    const auto found = receivers_.find(topic);
    if (found != receivers_.end()) found->second(message);
  }

 private:
  bool cdr_;
  std::map<std::string, Receive> receivers_;
};

// Handles images as a node does before they are frames.
void Take(const FrameImages& images, bool is_depth) {
  const ImageSize wanted{4, 4};
  try {
    (void)GrayOf(images.left, wanted);
    if (images.second && is_depth) (void)DepthOf(*images.second, wanted);
    if (images.second && !is_depth) (void)GrayOf(*images.second, wanted);
  } catch (const InputError&) {
  }
}

}  // namespace

// Messages of ROS 1 and ROS 2 on the topics of a node. The first byte chooses the form of messages
// and the kind of images, the second the topic; all that follows is sent as the message, twice.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const bool cdr = (data[0] & 1U) != 0, stereo = (data[0] & 2U) != 0, packed = (data[0] & 4U) != 0;
  InventedTransport transport(cdr);
  NodeLog log(transport);
  NodeParameters parameters;
  parameters.slam.sensor = stereo ? "stereo" : "rgbd";
  parameters.approximate_sync = (data[0] & 8U) != 0;
  if (packed) parameters.image_transport = "compressed";
  if (packed) parameters.depth_transport = "compressedDepth";
  InertialQueue samples(0.01, true);
  FrameSubscriber subscriber(
      transport,
      log,
      parameters,
      [&](const FrameImages& images) {
        (void)samples.MustWait(images.left.message.stamp_ns, images.left.message.stamp_ns);
        (void)samples.TakeUpTo(images.left.message.stamp_ns);
        Take(images, !stereo);
      },
      [&](const InertialMessage& measured) {
        if (const auto sample = SampleOf(measured)) samples.Add(*sample);
      });
  const std::string under = packed ? "/compressed" : "";
  const std::array<std::string, 8> topics = {"/image" + under,
                                             "/left/image" + under,
                                             "/right/image" + under,
                                             packed ? "/depth/compressedDepth" : "/depth",
                                             "/camera_info",
                                             "/left/camera_info",
                                             "/right/camera_info",
                                             "/imu"};
  const Bytes message(data + 2, data + size);
  for (int i = 0; i < 2; ++i) transport.Send(topics[data[1] % topics.size()], message);
  // Both of a pair, for what is done with whole ones.
  transport.Send(stereo ? topics[1] : topics[0], message);
  transport.Send(stereo ? topics[2] : topics[3], message);
  if (const auto cameras = subscriber.FindCameras()) {
    try {
      (void)CalibrationOf(cameras->first, cameras->second, false, false);
    } catch (const InputError&) {
    }
  }
  (void)ParseRosClock(cdr, message);
  TransformTree tree;
  for (const bool is_static : {false, true}) {
    if (const auto read = ParseRosTransforms(cdr, message)) tree.Add(*read, is_static);
    (void)tree.Find("base", "cam0");
  }
  return 0;
}
