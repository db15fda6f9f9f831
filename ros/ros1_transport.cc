// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros1_transport.h"

#include "plumbline/base/error.h"

#include <stdexcept>
#include <utility>

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/console.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

namespace plumbline::ros_node {

// A message of any type, as its bytes.
struct RawMessage {
  Bytes bytes;
};

}  // namespace plumbline::ros_node

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<plumbline::ros_node::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const plumbline::ros_node::RawMessage&) { return "*"; }
};
template <>
struct DataType<plumbline::ros_node::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const plumbline::ros_node::RawMessage&) { return "*"; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<plumbline::ros_node::RawMessage> {
  template <class Stream>
  static void write(Stream& stream, const plumbline::ros_node::RawMessage& message) {
    std::copy(message.bytes.begin(), message.bytes.end(), stream.advance(Length(message.bytes)));
  }
  template <class Stream>
  static void read(Stream& stream, plumbline::ros_node::RawMessage& message) {
    const std::uint32_t length = stream.getLength();
    const std::uint8_t* begin = stream.advance(length);
    message.bytes.assign(begin, begin + length);
  }
  static std::uint32_t serializedLength(const plumbline::ros_node::RawMessage& message) {
    return Length(message.bytes);
  }

 private:
  static std::uint32_t Length(const plumbline::ros_node::Bytes& bytes) {
    return static_cast<std::uint32_t>(bytes.size());
  }
};

}  // namespace serialization
}  // namespace ros

namespace plumbline::ros_node {
namespace {

using XmlRpc::XmlRpcValue;

// What ROS 1 wants to know of a type of messages.
struct TypeDescription {
  std::string type, md5sum, definition;
};

template <class... Messages>
TypeDescription Find(const std::string& type) {
  namespace traits = ros::message_traits;
  TypeDescription found;
  const auto match = [&](const char* name, const char* md5sum, const char* definition) {
    if (type == name) found = {name, md5sum, definition};
  };
  (match(traits::datatype<Messages>(), traits::md5sum<Messages>(), traits::definition<Messages>()),
   ...);
  if (found.type.empty()) throw std::logic_error(type + ": not among the types of the node");
  return found;
}

TypeDescription DescriptionOf(const std::string& type) {
  return Find<geometry_msgs::PoseStamped,
              nav_msgs::Odometry,
              nav_msgs::Path,
              sensor_msgs::CameraInfo,
              sensor_msgs::CompressedImage,
              sensor_msgs::Image,
              sensor_msgs::Imu,
              sensor_msgs::PointCloud2,
              std_msgs::String,
              tf2_msgs::TFMessage,
              visualization_msgs::Marker>(type);
}

class Ros1Publication : public Publication {
 public:
  explicit Ros1Publication(ros::Publisher publisher) : publisher_(std::move(publisher)) {}

  void Publish(const Bytes& message) override { publisher_.publish(RawMessage{message}); }
  bool HasSubscribers() const override { return publisher_.getNumSubscribers() > 0; }

 private:
  ros::Publisher publisher_;
};

bool IsOwn(const std::string& name) { return name.compare(0, 2, "~/") == 0; }

void AddParameters(const std::string& name, XmlRpcValue& value, Parameters& parameters) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      parameters[name] = static_cast<bool&>(value);
      return;
    case XmlRpcValue::TypeInt:
      parameters[name] = std::int64_t{static_cast<int&>(value)};
      return;
    case XmlRpcValue::TypeDouble:
      parameters[name] = static_cast<double&>(value);
      return;
    case XmlRpcValue::TypeString:
      parameters[name] = static_cast<std::string&>(value);
      return;
    case XmlRpcValue::TypeStruct:
      for (auto& [key, part] : value) {
        AddParameters(name.empty() ? key : name + "." + key, part, parameters);
      }
      return;
    default:
      parameters[name] = ListValue{};
  }
}

}  // namespace

Parameters Ros1Transport::ReadParameters() const {
  Parameters parameters;
  XmlRpcValue own;
  if (own_.getParam(own_.getNamespace(), own)) AddParameters("", own, parameters);
  return parameters;
}

std::string Ros1Transport::Resolve(const std::string& name) const {
  return IsOwn(name) ? own_.resolveName(name.substr(2)) : public_.resolveName(name);
}

void Ros1Transport::Subscribe(const TopicSettings& topic, Receive receive) {
  const TypeDescription type = DescriptionOf(topic.type);
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const boost::shared_ptr<const RawMessage>&>(
      topic.name,
      static_cast<std::uint32_t>(topic.queue_size),
      [receive = std::move(receive)](const boost::shared_ptr<const RawMessage>& message) {
        receive(message->bytes);
      });
  options.datatype = type.type;
  options.md5sum = type.md5sum;
  subscribers_.push_back(public_.subscribe(options));
}

void Ros1Transport::Repeat(double seconds, std::function<void()> work) {
  const boost::function<void(const ros::WallTimerEvent&)> call =
      [work = std::move(work)](const ros::WallTimerEvent&) { work(); };
  timers_.push_back(own_.createWallTimer(ros::WallDuration(seconds), call));
}

void Ros1Transport::After(double seconds, std::function<void()> work) {
  const boost::function<void(const ros::WallTimerEvent&)> call =
      [work = std::move(work)](const ros::WallTimerEvent&) { work(); };
  timers_.push_back(own_.createWallTimer(ros::WallDuration(seconds), call, true));
}

bool Ros1Transport::HasPublisher(const std::string& topic) const {
  for (const ros::Subscriber& subscriber : subscribers_) {
    if (subscriber.getTopic() == topic && subscriber.getNumPublishers() > 0) return true;
  }
  return false;
}

void Ros1Transport::OfferTrigger(const std::string& name, std::function<std::string()> work) {
  using std_srvs::Trigger;
  const boost::function<bool(Trigger::Request&, Trigger::Response&)> answer =
      [work = std::move(work)](Trigger::Request&, Trigger::Response& response) {
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
      };
  services_.push_back(public_.advertiseService(Resolve(name), answer));
}

std::unique_ptr<Publication> Ros1Transport::Advertise(const TopicSettings& topic) {
  const TypeDescription type = DescriptionOf(topic.type);
  ros::AdvertiseOptions options(topic.name,
                                static_cast<std::uint32_t>(topic.queue_size),
                                type.md5sum,
                                type.type,
                                type.definition);
  options.latch = topic.latched;
  return std::make_unique<Ros1Publication>(public_.advertise(options));
}

void Ros1Transport::Log(Severity severity, const std::string& line) {
  switch (severity) {
    case Severity::kInfo:
      ROS_INFO("%s", line.c_str());
      return;
    case Severity::kWarning:
      ROS_WARN("%s", line.c_str());
      return;
    case Severity::kError:
      ROS_ERROR("%s", line.c_str());
      return;
  }
}

}  // namespace plumbline::ros_node
