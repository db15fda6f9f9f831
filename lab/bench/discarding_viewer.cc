// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/bench/discarding_viewer.h"

#include "tests/support/web_socket_client.h"
#include <chrono>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

// The answer to the list of channels: all of them.
std::string SubscriptionToAll(const nlohmann::json& advertised) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& channel : advertised["channels"]) {
    list.push_back({{"id", list.size()}, {"channelId", channel["id"]}});
  }
  return nlohmann::json{{"op", "subscribe"}, {"subscriptions", list}}.dump();
}

}  // namespace

DiscardingViewer::DiscardingViewer(std::uint16_t port) : thread_([this, port] { Watch(port); }) {}

DiscardingViewer::~DiscardingViewer() {
  stop_ = true;
  thread_.join();
}

void DiscardingViewer::Watch(std::uint16_t port) {
  using namespace std::chrono_literals;
  while (!stop_) {
    try {
      WebSocketClient client(port);
      while (const auto message = client.Receive()) {
        bytes_ += message->bytes.size();
        if (message->binary) continue;
        const auto json = nlohmann::json::parse(message->bytes, nullptr, false);
        if (json.is_object() && json.value("op", "") == "advertise") {
          client.SendText(SubscriptionToAll(json));
        }
      }
      return;
    } catch (const std::runtime_error&) {  // no server yet
      std::this_thread::sleep_for(20ms);
    }
  }
}

}  // namespace plumbline
