// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/foxglove/protocol.h"
#include "plumbline/view/map_question.h"
#include "plumbline/view/view_state.h"
#include "plumbline/view/web_server.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace plumbline {

// Who asks, to be named in the answer.
struct CallId {
  std::uint64_t client = 0;
  std::uint32_t service = 0, call = 0;
};

// What clients may ask for besides what they see.
struct ViewActions {
  std::function<void(bool paused)> pause;
  std::function<void()> step;  // one frame while paused
  std::function<void(CallId, const MapQuestion&)> ask;
  // ServeAll is to be called then.
  std::function<void(std::chrono::steady_clock::time_point)> wake_at;
};

// The viewers that are connected, in Foxglove's protocol. Each is sent the next messages when it
// has taken those before, at most 30 times a second: a slow one gets fewer frames, and never has
// more than one of each stream on its way. For the thread of the server.
class ViewClients {
 public:
  static constexpr auto kBetweenMessages = std::chrono::milliseconds(33);

  ViewClients(ViewState& state, const std::string& name, bool can_pause, ViewActions actions);

  void Opened(WebClient& client);
  void Received(WebClient& client, std::string_view message, bool binary);
  void Closed(WebClient& client) { clients_.erase(&client); }
  void Serve(WebClient& client);
  void ServeAll();
  // To a client that may be gone meanwhile.
  void Answer(const CallId& id, const std::string& json);

  // Whether anybody wants frames, or the map.
  bool frames_wanted() const;
  bool map_wanted() const;
  // Whether everybody has been sent everything.
  bool all_served() const;

 private:
  struct Viewer {
    std::uint64_t number = 0;
    std::array<std::optional<std::uint32_t>, kStreams> subscriptions;  // by stream
    ViewCursor cursor;
    std::chrono::steady_clock::time_point next;  // not before
  };

  void Do(WebClient& client, const Subscribe& message);
  void Do(WebClient& client, const Unsubscribe& message);
  void Do(WebClient& client, const ServiceCall& message);
  void Do(WebClient& client, const NotOffered& message);
  bool IsWanted(Stream stream) const;

  ViewState& state_;
  bool can_pause_;
  ViewActions actions_;
  std::string hello_, channels_, services_;  // what everybody gets first
  std::map<WebClient*, Viewer> clients_;
  std::uint64_t next_number_ = 1;
};

}  // namespace plumbline
