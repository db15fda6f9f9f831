// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros2_transport.h"

#include "plumbline/base/error.h"
#include "plumbline/io/recordings/image_message.h"

#include "message_writer.h"
#include "node_log.h"
#include "ros2_type_hashes.h"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <list>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fmt/format.h>

namespace plumbline::ros_node {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

using Clock = std::chrono::steady_clock;

constexpr int kOk = 0;
// Bytes of messages that are taken from others: images and the rest. A fragment says how large the
// whole is, and memory for it is taken at once.
constexpr std::uint32_t kLargestImage = 64U << 20U, kLargestMessage = 1U << 20U;
constexpr std::uint32_t kSocketBuffer = 8U
                                        << 20U;  // bytes; a few images, as far as the system has it

constexpr std::uint32_t kMostLocalPeers = 10;
constexpr double kSecondsBetweenWarnings = 5;

// Messages of any type, as their bytes. m_typeSize is the largest that is taken; of what is
// published it is none.
class RawType : public dds::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = name.ends_with("Image_") ? kLargestImage : kLargestMessage;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

// "sensor_msgs/Image" as ROS 2 names it in DDS; messages of services are those of std_srvs.
std::string DdsTypeOf(const std::string& type) {
  const std::size_t slash = type.find('/');
  const std::string package = type.substr(0, slash);
  return package + (package == "std_srvs" ? "::srv" : "::msg") +
         "::dds_::" + type.substr(slash + 1) + "_";
}

std::vector<rtps::octet> OctetsOf(const std::string& text) { return {text.begin(), text.end()}; }

template <class Qos>
void SetQos(const TopicSettings& topic, bool reliable, Qos& qos) {
  qos.user_data().data_vec(OctetsOf(UserDataOfType(topic.type)));
  qos.reliability().kind =
      reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      topic.latched ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = topic.queue_size;
  qos.resource_limits().max_samples = topic.queue_size;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = topic.queue_size;
  qos.resource_limits().allocated_samples = 1;
}

template <class T>
T* OrFail(T* made, const std::string& what) {
  if (made == nullptr) throw std::runtime_error("DDS: " + what + " cannot be made");
  return made;
}

// A request of a service without arguments (std_srvs/Trigger).
//
// rmw_fastrtps tells in the data of DDS which request a reply is for (related_sample_identity: who
// asked, and how often). rmw_cyclonedds has 16 bytes for this in front of the message, of requests
// and replies.
struct TriggerRequest {
  rtps::SampleIdentity identity;
  Bytes header;  // of rmw_cyclonedds, little-endian; else empty

  // nullopt for bytes that are none.
  static std::optional<TriggerRequest> Parse(const Bytes& bytes, const dds::SampleInfo& info) {
    constexpr std::size_t kEncoding = 4, kHeader = 16, kMostPadded = 4;
    if (bytes.size() < kEncoding || bytes[0] != 0 || bytes[1] > 1) return std::nullopt;
    TriggerRequest request;
    request.identity = info.sample_identity;
    if (info.related_sample_identity.writer_guid() != rtps::GUID_t::unknown()) {
      request.identity.writer_guid(info.related_sample_identity.writer_guid());
    }
    const std::size_t size = bytes.size() - kEncoding;
    if (size <= kMostPadded) return request;
    if (size < kHeader || size > kHeader + kMostPadded) return std::nullopt;
    const auto begin = bytes.begin() + kEncoding, middle = begin + kHeader / 2;
    request.header.assign(begin, begin + kHeader);
    if (bytes[1] == 0) {
      std::reverse_copy(begin, middle, request.header.begin());
      std::reverse_copy(middle, middle + kHeader / 2, request.header.begin() + kHeader / 2);
    }
    return request;
  }

  Bytes Reply(bool success, const std::string& text) const {
    MessageWriter message(true);
    message.U8(success ? 1 : 0);
    message.Text(text);
    Bytes bytes = message.bytes();
    bytes.insert(bytes.begin() + 4, header.begin(), header.end());
    return bytes;
  }
};

class Ros2Publication : public Publication {
 public:
  explicit Ros2Publication(dds::DataWriter* writer) : writer_(writer) {}

  void Publish(const Bytes& message) override { writer_->write(const_cast<Bytes*>(&message)); }
  bool HasSubscribers() const override {
    dds::PublicationMatchedStatus status;
    return writer_->get_publication_matched_status(status)() == kOk && status.current_count > 0;
  }

 private:
  dds::DataWriter* writer_;  // the participant's
};

}  // namespace

class Ros2Transport::Implementation {
 public:
  using Receive = std::function<void(Bytes, const dds::SampleInfo&)>;

  Implementation(const Ros2Settings& settings, Transport& transport)
      : settings_(settings), log_(transport) {
    dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
    qos.name(settings.name);
    qos.user_data().data_vec(OctetsOf("enclave=/;"));
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->receiveBufferSize = udp->sendBufferSize = kSocketBuffer;
    if (settings.localhost_only) {
      // Loopback often has no multicast: others are looked for at their usual ports, too.
      udp->interfaceWhiteList = {"127.0.0.1"};
      udp->maxInitialPeersRange = kMostLocalPeers;
      for (const char* address : {"127.0.0.1", "239.255.0.1"}) {
        rtps::Locator_t peer;
        rtps::IPLocator::setIPv4(peer, address);
        qos.wire_protocol().builtin.initialPeersList.push_back(peer);
      }
    }
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports = {udp};
    participant_ = OrFail(
        dds::DomainParticipantFactory::get_instance()->create_participant(settings.domain, qos),
        "a participant of domain " + std::to_string(settings.domain));
    publisher_ = OrFail(participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT), "a publisher");
    subscriber_ =
        OrFail(participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT), "a subscriber");
    if (settings.use_sim_time) ListenToClock();
  }
  ~Implementation() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  const Ros2Settings& settings() const { return settings_; }

  void Subscribe(const TopicSettings& topic, Transport::Receive receive) {
    MakeReader("rt" + topic.name,
               topic,
               [receive = std::move(receive)](Bytes bytes, const dds::SampleInfo&) {
                 receive(std::move(bytes));
               });
  }

  void OfferTrigger(const std::string& service, std::function<std::string()> work) {
    constexpr int kQueue = 10;
    const TopicSettings requests{"rq" + service + "Request", "std_srvs/Trigger_Request", kQueue};
    const TopicSettings replies{"rr" + service + "Reply", "std_srvs/Trigger_Response", kQueue};
    dds::DataWriter* writer = MakeWriter(replies.name, replies);
    writers_.push_back(writer);
    MakeReader(requests.name,
               requests,
               [this, requests, writer, work = std::move(work)](const Bytes& bytes,
                                                                const dds::SampleInfo& info) {
                 const auto request = TriggerRequest::Parse(bytes, info);
                 if (!request) return log_.Refuse(requests, bytes.size());
                 Bytes reply;
                 try {
                   const std::string done = work();
                   log_.Say(Severity::kInfo, done);
                   reply = request->Reply(true, done);
                 } catch (const InputError& error) {
                   log_.Say(Severity::kError, error.what());
                   reply = request->Reply(false, error.what());
                 }
                 rtps::WriteParams parameters;
                 parameters.related_sample_identity(request->identity);
                 writer->write(&reply, parameters);
               });
  }

  void MakeReader(const std::string& topic_name, const TopicSettings& topic, Receive receive) {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    SetQos(topic, !topic.sensor_data || settings_.reliable, qos);
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_MEMORY_MODE;
    dds::DataReader* reader =
        OrFail(subscriber_->create_datareader(MakeTopic(topic_name, DdsTypeOf(topic.type)), qos),
               "a subscription of " + topic.name);
    dds::StatusCondition& status = reader->get_statuscondition();
    dds::StatusMask awaited = dds::StatusMask::data_available();
    awaited << dds::StatusMask::requested_incompatible_qos();
    awaited << dds::StatusMask::sample_lost();
    status.set_enabled_statuses(awaited);
    waits_.attach_condition(status);
    subscriptions_.push_back({topic.name, reader, std::move(receive)});
  }

  dds::DataWriter* MakeWriter(const std::string& topic_name, const TopicSettings& topic) {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    SetQos(topic, true, qos);
    qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
    // What is latched may have any size. All else fits a datagram, and goes out at once.
    qos.publish_mode().kind =
        topic.latched ? dds::ASYNCHRONOUS_PUBLISH_MODE : dds::SYNCHRONOUS_PUBLISH_MODE;
    return OrFail(publisher_->create_datawriter(MakeTopic(topic_name, DdsTypeOf(topic.type)), qos),
                  "a publication of " + topic_name);
  }
  std::unique_ptr<Publication> Advertise(const TopicSettings& topic) {
    dds::DataWriter* writer = MakeWriter("rt" + topic.name, topic);
    writers_.push_back(writer);
    return std::make_unique<Ros2Publication>(writer);
  }

  void Repeat(double seconds, std::function<void()> work) {
    const auto period = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(std::min(seconds, 1e6)));
    timers_.push_back({Now() + period, period, std::move(work)});
  }

  void After(double seconds, std::function<void()> work) {
    const auto delay =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    later_.push_back({Clock::now() + delay, delay, std::move(work)});
  }

  // Also of another QoS, which CheckQos tells.
  bool HasPublisher(const std::string& topic) const {
    for (const Subscription& subscription : subscriptions_) {
      dds::SubscriptionMatchedStatus status;
      if (subscription.topic != topic) continue;
      const bool matched = subscription.reader->get_subscription_matched_status(status)() == kOk &&
                           status.current_count > 0;
      if (matched || subscription.has_other_qos) return true;
    }
    return false;
  }

  void Run(const std::function<bool()>& stop) {
    Introduce();
    Repeat(kSecondsBetweenWarnings, [&] {
      for (Subscription& subscription : subscriptions_) WarnOfLosses(subscription);
    });
    while (!stop()) {
      dds::ConditionSeq active;
      waits_.wait(active, eprosima::fastrtps::Duration_t(0, 100'000'000));
      for (Subscription& subscription : subscriptions_) {
        ReceiveAll(subscription);
        CheckQos(subscription);
        CountLosses(subscription);
      }
      for (Timer& timer : timers_) {
        const Clock::time_point now = Now();
        timer.next = std::min(timer.next, now + timer.period);  // /clock may jump back
        if (now < timer.next) continue;
        timer.next = now + timer.period;
        timer.work();
      }
      DoWhatIsDue();
    }
    for (Subscription& subscription : subscriptions_) WarnOfLosses(subscription);
  }

 private:
  struct Subscription {
    std::string topic;
    dds::DataReader* reader = nullptr;
    Receive receive;
    Bytes bytes = {};
    std::int64_t lost = 0;  // not yet told
    bool has_other_qos = false;
  };
  struct Timer {
    Clock::time_point next;
    Clock::duration period;
    std::function<void()> work;
  };

  void DoWhatIsDue() {
    const Clock::time_point now = Clock::now();
    for (const Timer& timer : later_) {
      if (timer.next <= now) timer.work();
    }
    std::erase_if(later_, [now](const Timer& timer) { return timer.next <= now; });
  }

  dds::Topic* MakeTopic(const std::string& name, const std::string& type) {
    if (auto* known = dynamic_cast<dds::Topic*>(participant_->lookup_topicdescription(name))) {
      return known;
    }
    dds::TypeSupport(new RawType(type)).register_type(participant_);
    return OrFail(participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT), "topic " + name);
  }

  static void ReceiveAll(Subscription& subscription) {
    dds::SampleInfo info;
    while (subscription.reader->take_next_sample(&subscription.bytes, &info)() == kOk) {
      if (info.valid_data) subscription.receive(std::exchange(subscription.bytes, {}), info);
    }
  }

  void CheckQos(Subscription& subscription) {
    dds::RequestedIncompatibleQosStatus status;
    subscription.reader->get_requested_incompatible_qos_status(status);
    if (status.total_count_change == 0) return;
    subscription.has_other_qos = true;
    log_.Say(Severity::kWarning,
             subscription.topic +
                 ": a publisher has another QoS, and nothing of it comes (parameter reliability: "
                 "best_effort takes both kinds)");
  }

  Clock::time_point Now() const { return settings_.use_sim_time ? sim_time_ : Clock::now(); }

  void ListenToClock() {
    TopicSettings topic{settings_.Resolve("/clock"), "rosgraph_msgs/Clock"};
    topic.sensor_data = true;
    Subscribe(topic, [this, topic](const Bytes& message) {
      const auto now_ns = ParseRosClock(true, message);
      if (!now_ns) return log_.Refuse(topic, message.size());
      sim_time_ = Clock::time_point(std::chrono::nanoseconds(*now_ns));
    });
  }

  static void CountLosses(Subscription& subscription) {
    dds::SampleLostStatus status;
    subscription.reader->get_sample_lost_status(status);
    subscription.lost += status.total_count_change;
  }

  void WarnOfLosses(Subscription& subscription) {
    const std::int64_t lost = std::exchange(subscription.lost, 0);
    if (lost == 0) return;
    log_.Say(Severity::kWarning,
             fmt::format("{}: {} messages were lost on the way (net.core.rmem_max, or the "
                         "parameter reliability)",
                         subscription.topic,
                         lost));
  }

  // Tells which node the endpoints belong to.
  void Introduce() {
    TopicSettings topic{"ros_discovery_info", "rmw_dds_common/ParticipantEntitiesInfo"};
    topic.latched = true;
    dds::DataWriter* writer = MakeWriter(topic.name, topic);
    MessageWriter message(true);
    const auto gid = [&](const rtps::GUID_t& guid) {
      for (const rtps::octet part : guid.guidPrefix.value) message.U8(part);
      for (const rtps::octet part : guid.entityId.value) message.U8(part);
      for (std::size_t i = 16; i < settings_.gid_size; ++i) message.U8(0);
    };
    gid(participant_->guid());
    message.U32(1);  // nodes
    message.Text(settings_.name_space);
    message.Text(settings_.name);
    message.U32(static_cast<std::uint32_t>(subscriptions_.size()));
    for (const Subscription& subscription : subscriptions_) gid(subscription.reader->guid());
    message.U32(static_cast<std::uint32_t>(writers_.size()));
    for (const dds::DataWriter* one : writers_) gid(one->guid());
    Ros2Publication(writer).Publish(message.bytes());
  }

  Ros2Settings settings_;
  NodeLog log_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  dds::WaitSet waits_;
  std::list<Subscription> subscriptions_;
  std::vector<dds::DataWriter*> writers_;
  std::vector<Timer> timers_;
  std::vector<Timer> later_;    // called once, by the steady clock
  Clock::time_point sim_time_;  // of /clock; the beginning of time before it came
};

Ros2Transport::Ros2Transport(const Ros2Settings& settings)
    : implementation_(std::make_unique<Implementation>(settings, *this)) {}
Ros2Transport::~Ros2Transport() = default;

void Ros2Transport::Run(const std::function<bool()>& stop) { implementation_->Run(stop); }
std::string Ros2Transport::Resolve(const std::string& name) const {
  return implementation_->settings().Resolve(name);
}
void Ros2Transport::Subscribe(const TopicSettings& topic, Receive receive) {
  implementation_->Subscribe(topic, std::move(receive));
}
void Ros2Transport::Repeat(double seconds, std::function<void()> work) {
  implementation_->Repeat(seconds, std::move(work));
}
void Ros2Transport::After(double seconds, std::function<void()> work) {
  implementation_->After(seconds, std::move(work));
}
bool Ros2Transport::HasPublisher(const std::string& topic) const {
  return implementation_->HasPublisher(topic);
}
void Ros2Transport::OfferTrigger(const std::string& name, std::function<std::string()> work) {
  implementation_->OfferTrigger(Resolve(name), std::move(work));
}
std::unique_ptr<Publication> Ros2Transport::Advertise(const TopicSettings& topic) {
  return implementation_->Advertise(topic);
}

void Ros2Transport::Log(Severity severity, const std::string& line) {
  static constexpr const char* kNames[] = {"", "warning: ", "error: "};
  std::fprintf(stderr, "plumbline-ros2: %s%s\n", kNames[static_cast<int>(severity)], line.c_str());
}

}  // namespace plumbline::ros_node
