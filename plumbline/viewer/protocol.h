// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/viewer/schemas.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace plumbline {

// Messages of Foxglove's WebSocket protocol (github.com/foxglove/ws-protocol) for a server of
// channels and services. Clients cannot publish.

// Supported subprotocols, the best first. They agree in everything used here.
inline constexpr std::array<std::string_view, 2> kFoxgloveSubprotocols = {"foxglove.sdk.v1",
                                                                          "foxglove.websocket.v1"};

// A function of the server that clients call, with JSON in both directions.
struct FoxgloveService {
  std::string_view name;  // "/plumbline/pause"
  std::string_view type;  // a name for its arguments and results
};

// --- from the server ---

// session: a text that differs for every run of the server.
std::string ServerInfoText(std::string_view name, std::string_view session);
// The ids of channels and services are their positions in the lists, from 1 on.
std::string AdvertiseText(std::span<const FoxgloveChannel> channels, std::string_view schemas);
std::string AdvertiseServicesText(std::span<const FoxgloveService> services);
enum class StatusLevel { kInfo = 0, kWarning = 1, kError = 2 };
std::string StatusText(StatusLevel level, std::string_view message);
// Returns the header of a binary message data message. received_ns: time at which the server got
// the message.
std::string MessageDataHead(std::uint32_t subscription, std::int64_t received_ns);
std::string ServiceAnswer(std::uint32_t service, std::uint32_t call, std::string_view json);
std::string ServiceFailureText(std::uint32_t service, std::uint32_t call, std::string_view message);

// --- from a client ---

struct Subscribe {
  struct Entry {
    std::uint32_t id = 0;  // the client's name for the subscription
    std::uint32_t channel = 0;
  };
  std::vector<Entry> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
struct ServiceCall {
  std::uint32_t service = 0;
  std::uint32_t call = 0;
  std::string json;
};
// A part of the protocol that this server does not support.
struct NotOffered {
  std::string what;
};
using ClientMessage = std::variant<Subscribe, Unsubscribe, ServiceCall, NotOffered>;

// Return nullopt for an invalid message.
std::optional<ClientMessage> ParseClientText(std::string_view text);
std::optional<ClientMessage> ParseClientBinary(std::string_view bytes);

}  // namespace plumbline
