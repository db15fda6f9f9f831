// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"
#include "plumbline/viewer/protocol.h"
#include "plumbline/viewer/view_state.h"
#include "plumbline/viewer/web_server.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace plumbline {

// Query for the keyframes that see a landmark of the active map.
struct MapQuestion {
  bool is_line = false;
  std::int64_t id = 0;
};

// Parses {"point": 12} or {"line": 3}; returns nullopt for anything else.
std::optional<MapQuestion> ParseMapQuestion(std::string_view json);

// Returns {"point": 12, "seen_by": [{"keyframe": 3, "frame": 17, "px": [x, y]}, ...]}, the oldest
// keyframe first. For a line "px" is [x1, y1, x2, y2] (rectified left image). "seen_by" is empty if
// the landmark has left the map. O(keyframes that see it).
std::string AnswerMapQuestion(const Atlas& atlas, const MapQuestion& question);

// Identifies a client's call, for the answer.
struct CallId {
  std::uint64_t client = 0;
  std::uint32_t service = 0, call = 0;
};

// Actions that clients may request in addition to the streams.
struct ViewActions {
  std::function<void(bool paused)> pause;
  std::function<void()> step;  // shows one frame while the run is paused
  // Returns false if too many queries are waiting.
  std::function<bool(CallId, const MapQuestion&)> ask;
  // Requests a call of ServeAll at a time.
  std::function<void(std::chrono::steady_clock::time_point)> wake_at;
};

// The connected viewers, in Foxglove's protocol. Each gets the next messages when it has received
// the previous ones, at most 30 times a second. A slow viewer thus gets fewer frames, and never has
// more than one pending message of each stream. For the thread of the server.
class ViewClients {
 public:
  static constexpr auto kBetweenMessages = std::chrono::milliseconds(33);

  ViewClients(ViewState& state, const std::string& name, bool can_pause, ViewActions actions);

  void Opened(WebClient& client);
  void Received(WebClient& client, std::string_view message, bool binary);
  void Closed(WebClient& client) { clients_.erase(&client); }
  void Serve(WebClient& client);
  void ServeAll();
  // Sends an answer to a client, if it is still connected.
  void Answer(const CallId& id, const std::string& json);

  // Return true if any client wants frames, or the map.
  bool frames_wanted() const;
  bool map_wanted() const;
  // Returns true if all clients are up to date.
  bool all_served() const;

 private:
  struct Viewer {
    std::uint64_t number = 0;
    // Subscription of each stream.
    std::array<std::optional<std::uint32_t>, kStreams> subscriptions;
    ViewCursor cursor;
    std::chrono::steady_clock::time_point next;  // earliest time of the next messages
  };

  void Do(WebClient& client, const Subscribe& message);
  void Do(WebClient& client, const Unsubscribe& message);
  void Do(WebClient& client, const ServiceCall& message);
  void Do(WebClient& client, const NotOffered& message);
  bool IsWanted(Stream stream) const;

  ViewState& state_;
  bool can_pause_;
  ViewActions actions_;
  std::string hello_, channels_, services_;  // first messages to every client
  std::map<WebClient*, Viewer> clients_;
  std::uint64_t next_number_ = 1;
};

}  // namespace plumbline
