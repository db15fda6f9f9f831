// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

// What carries messages between the node and others: ROS 1, or the DDS of ROS 2. Nothing of C++20,
// which the headers of ROS 1 do not compile as, is in this header.
namespace plumbline::ros_node {

using Bytes = std::vector<std::uint8_t>;
struct ListValue {};  // no parameter is a list
using ParameterValue = std::variant<bool, std::int64_t, double, std::string, ListValue>;
// Values by name; names in groups are joined by dots: "options.features.line_count".
using Parameters = std::map<std::string, ParameterValue>;

// How messages name parameters: "~sensor", "node.yaml:4: sensor".
struct ParameterNames {
  std::string prefix = {};                          // in front of each
  std::map<std::string, std::string> sources = {};  // "node.yaml:4" of those of a file, by name
  std::vector<std::string> others = {};             // that the transport reads itself

  std::string Shown(const std::string& name) const {
    const auto source = sources.find(name);
    return (source != sources.end() ? source->second + ": " : "") + prefix + name;
  }
};

enum class Severity { kInfo, kWarning, kError };

// How a topic is carried.
struct TopicSettings {
  std::string name;  // as Transport::Resolve returns it
  std::string type;  // as ROS 1 names it: "sensor_msgs/Image"
  int queue_size = 1;
  bool latched = false;      // those who come later get the last message, too
  bool sensor_data = false;  // messages may be lost rather than come late
};

// A topic that the node publishes. All functions may be called in any thread.
class Publication {
 public:
  virtual ~Publication() = default;
  virtual void Publish(const Bytes& message) = 0;
  virtual bool HasSubscribers() const = 0;
};

class Transport {
 public:
  using Receive = std::function<void(Bytes message)>;

  virtual ~Transport() = default;

  // The form of messages: CDR of ROS 2, or the one of ROS 1.
  virtual bool UsesCdr() const = 0;
  // The name of a topic after remapping, from / on. `name` is relative to the namespace of the node
  // ("left/image"), to the node ("~/pose"), or neither ("/tf").
  virtual std::string Resolve(const std::string& name) const = 0;

  // Functions handed over are called in one thread, and not before the loop of the transport runs.
  virtual void Subscribe(const TopicSettings& topic, Receive receive) = 0;
  virtual void Repeat(double seconds, std::function<void()> work) = 0;
  // Once, after so many seconds of the loop, whatever time is simulated.
  virtual void After(double seconds, std::function<void()> work) = 0;
  // Whether somebody publishes a topic that is subscribed (TopicSettings::name).
  virtual bool HasPublisher(const std::string& topic) const = 0;
  // A service without arguments, std_srvs/Trigger. What `work` returns is the answer of success;
  // an InputError is that of a failure.
  virtual void OfferTrigger(const std::string& name, std::function<std::string()> work) = 0;
  virtual std::unique_ptr<Publication> Advertise(const TopicSettings& topic) = 0;

  // In any thread.
  virtual void Log(Severity severity, const std::string& line) = 0;
};

}  // namespace plumbline::ros_node
