// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "raw_type.h"
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include <dds/dds.h>

namespace plumbline {

// Waits for a condition, at most so many seconds.
inline bool WaitUntil(const std::function<bool()>& condition, int seconds = 20) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

struct PeerQos {
  bool reliable = true;
  bool transient_local = false;
  int most_samples = 0;  // keep all, and no more than these; 0: the last hundred
};

// A participant of Cyclone DDS on a network interface; its topics live as long as it. Others are
// found by multicast but on loopback, where there may be none.
class DdsPeer {
 public:
  explicit DdsPeer(unsigned domain, const std::string& interface = "lo") {
    const std::string peers = interface == "lo"
                                  ? "<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>"
                                    "<Peer Address=\"127.0.0.1\"/></Peers></Discovery>"
                                  : "";
    const std::string settings =
        "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"" + interface +
        "\"/></Interfaces></General>" + peers + "</Domain></CycloneDDS>";
    ::setenv("CYCLONEDDS_URI", settings.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    participant_ = dds_create_participant(domain, nullptr, nullptr);
  }
  ~DdsPeer() { dds_delete(participant_); }
  DdsPeer(const DdsPeer&) = delete;
  DdsPeer& operator=(const DdsPeer&) = delete;

  dds_entity_t MakeWriter(const std::string& topic,
                          const dds_topic_descriptor_t& type,
                          PeerQos wanted = {}) {
    return WriterOf(Topic(topic, type), wanted);
  }
  // Of samples std::vector<std::uint8_t>, sent as they are under the name of a type.
  dds_entity_t MakeRawWriter(const std::string& topic, const std::string& type) {
    return WriterOf(raw_type::MakeTopic(participant_, topic, type), {});
  }
  dds_entity_t MakeReader(const std::string& topic,
                          const dds_topic_descriptor_t& type,
                          PeerQos wanted = {}) {
    dds_qos_t* qos = QosOf(wanted);
    const dds_entity_t reader = dds_create_reader(participant_, Topic(topic, type), qos, nullptr);
    dds_delete_qos(qos);
    return reader;
  }

  // The reader of a type of ours in the name of another one.
  dds_entity_t MakeReaderNamed(const std::string& topic,
                               dds_topic_descriptor_t type,
                               const std::string& type_name) {
    type.m_typename = type_name.c_str();
    return MakeReader(topic, type);
  }
  // Of a topic that Cyclone DDS has by itself.
  dds_entity_t MakeReaderOf(dds_entity_t topic) {
    return dds_create_reader(participant_, topic, nullptr, nullptr);
  }

  static bool HasReader(dds_entity_t writer) {
    dds_publication_matched_status_t status;
    return dds_get_publication_matched_status(writer, &status) == 0 && status.current_count > 0;
  }
  static bool HasWriter(dds_entity_t reader) {
    dds_subscription_matched_status_t status;
    return dds_get_subscription_matched_status(reader, &status) == 0 && status.current_count > 0;
  }
  // Waits for a message, or for some time.
  void WaitForMessage(dds_entity_t reader, std::chrono::nanoseconds longest) const {
    dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
    const dds_entity_t waits = dds_create_waitset(participant_);
    dds_waitset_attach(waits, reader, 0);
    dds_waitset_wait(waits, nullptr, 0, std::max<std::int64_t>(0, longest.count()));
    dds_delete(waits);
  }
  // Takes the next message and hands it to `use`; false if there is none.
  template <class Message>
  static bool Take(dds_entity_t reader, const std::function<void(const Message&)>& use) {
    void* sample = nullptr;
    dds_sample_info_t info;
    const dds_return_t count = dds_take(reader, &sample, &info, 1, 1);
    const bool is_valid = count == 1 && info.valid_data;
    if (is_valid) use(*static_cast<const Message*>(sample));
    if (count > 0) dds_return_loan(reader, &sample, count);
    return is_valid;
  }

 private:
  dds_entity_t WriterOf(dds_entity_t topic, PeerQos wanted) {
    dds_qos_t* qos = QosOf(wanted);
    const dds_entity_t writer = dds_create_writer(participant_, topic, qos, nullptr);
    dds_delete_qos(qos);
    return writer;
  }
  dds_entity_t Topic(const std::string& name, const dds_topic_descriptor_t& type) {
    return dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr);
  }
  static dds_qos_t* QosOf(PeerQos wanted) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(
        qos, wanted.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_SECS(1));
    dds_qset_durability(
        qos, wanted.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 100);
    if (wanted.most_samples > 0) {
      const int most = wanted.most_samples;
      dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
      dds_qset_resource_limits(qos, most, DDS_LENGTH_UNLIMITED, most);
    }
    return qos;
  }

  dds_entity_t participant_ = 0;
};

}  // namespace plumbline
