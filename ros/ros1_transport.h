// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport.h"
#include <memory>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>

namespace plumbline::ros_node {

// The transport of ROS 1; ros::init must have been called, and ros::spin is its loop.
class Ros1Transport : public Transport {
 public:
  // The private parameters of the node.
  Parameters ReadParameters() const;

  bool UsesCdr() const override { return false; }
  std::string Resolve(const std::string& name) const override;
  void Subscribe(const TopicSettings& topic, Receive receive) override;
  void Repeat(double seconds, std::function<void()> work) override;
  void After(double seconds, std::function<void()> work) override;
  bool HasPublisher(const std::string& topic) const override;
  void OfferTrigger(const std::string& name, std::function<std::string()> work) override;
  std::unique_ptr<Publication> Advertise(const TopicSettings& topic) override;
  void Log(Severity severity, const std::string& line) override;

 private:
  ros::NodeHandle public_, own_{"~"};
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::WallTimer> timers_;
};

}  // namespace plumbline::ros_node
