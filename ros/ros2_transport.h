// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ros2_arguments.h"
#include "transport.h"
#include <functional>
#include <memory>
#include <string>

namespace plumbline::ros_node {

// The transport of ROS 2: DDS topics named and typed as its nodes have them ("rt/image",
// "sensor_msgs::msg::dds_::Image_"), by Fast DDS, over UDP alone. Messages are handed over as their
// CDR bytes. Services are those of rmw_fastrtps and of rmw_cyclonedds. What is repeated is so by
// the steady clock, or by /clock where use_sim_time is set: not before it comes, and not while it
// stands.
//
// Other nodes learn of the node by the topic ros_discovery_info (rmw_dds_common,
// ParticipantEntitiesInfo).
class Ros2Transport : public Transport {
 public:
  // Throws std::runtime_error if DDS cannot be started.
  explicit Ros2Transport(const Ros2Settings& settings);
  ~Ros2Transport() override;

  // Receives messages, one after the other, until `stop` says so, which is asked ten times a
  // second.
  void Run(const std::function<bool()>& stop);

  bool UsesCdr() const override { return true; }
  std::string Resolve(const std::string& name) const override;
  void Subscribe(const TopicSettings& topic, Receive receive) override;
  void Repeat(double seconds, std::function<void()> work) override;
  void After(double seconds, std::function<void()> work) override;
  bool HasPublisher(const std::string& topic) const override;
  void OfferTrigger(const std::string& name, std::function<std::string()> work) override;
  std::unique_ptr<Publication> Advertise(const TopicSettings& topic) override;
  void Log(Severity severity, const std::string& line) override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace plumbline::ros_node
