// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/protocol.h"

#include "plumbline/base/base64.h"

#include <limits>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using nlohmann::json;

constexpr std::size_t kMostSubscriptions = 64;  // most subscriptions in one message
constexpr char kMessageData = 1, kServiceResponse = 3;
constexpr char kClientMessageData = 1, kServiceRequest = 2;

std::string Dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

void PutNumber(std::string& to, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) to += static_cast<char>(value >> (8 * i));
}

std::uint32_t NumberAt(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8U | static_cast<std::uint8_t>(bytes[at + i]);
  }
  return value;
}

std::optional<std::uint32_t> IdOf(const json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

// Returns the member; null if it is missing.
const json& Member(const json& object, const char* name) {
  static const json null;
  const auto it = object.find(name);
  return it == object.end() ? null : *it;
}

std::optional<ClientMessage> ParseSubscribe(const json& message) {
  const json& list = Member(message, "subscriptions");
  if (!list.is_array() || list.size() > kMostSubscriptions) return std::nullopt;
  Subscribe subscribe;
  for (const json& entry : list) {
    if (!entry.is_object()) return std::nullopt;
    const auto id = IdOf(Member(entry, "id")), channel = IdOf(Member(entry, "channelId"));
    if (!id || !channel) return std::nullopt;
    subscribe.subscriptions.push_back({*id, *channel});
  }
  return subscribe;
}

std::optional<ClientMessage> ParseUnsubscribe(const json& message) {
  const json& list = Member(message, "subscriptionIds");
  if (!list.is_array() || list.size() > kMostSubscriptions) return std::nullopt;
  Unsubscribe unsubscribe;
  for (const json& entry : list) {
    const auto id = IdOf(entry);
    if (!id) return std::nullopt;
    unsubscribe.ids.push_back(*id);
  }
  return unsubscribe;
}

}  // namespace

std::string ServerInfoText(std::string_view name, std::string_view session) {
  return Dump({{"op", "serverInfo"},
               {"name", name},
               {"capabilities", {"services"}},
               {"supportedEncodings", {"json"}},
               {"metadata", json::object()},
               {"sessionId", session}});
}

std::string AdvertiseText(std::span<const FoxgloveChannel> channels, std::string_view schemas) {
  const std::string schema = EncodeBase64(schemas);
  json list = json::array();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    list.push_back({{"id", i + 1},
                    {"topic", channels[i].topic},
                    {"encoding", "protobuf"},
                    {"schemaName", channels[i].type},
                    {"schemaEncoding", "protobuf"},
                    {"schema", schema}});
  }
  return Dump({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string AdvertiseServicesText(std::span<const FoxgloveService> services) {
  json list = json::array();
  for (std::size_t i = 0; i < services.size(); ++i) {
    const std::string type(services[i].type);
    const auto schema = [&](const char* suffix) {
      return json{{"encoding", "json"},
                  {"schemaName", type + suffix},
                  {"schemaEncoding", "jsonschema"},
                  {"schema", R"({"type":"object"})"}};
    };
    list.push_back({{"id", i + 1},
                    {"name", services[i].name},
                    {"type", type},
                    {"request", schema("Request")},
                    {"response", schema("Response")}});
  }
  return Dump({{"op", "advertiseServices"}, {"services", std::move(list)}});
}

std::string StatusText(StatusLevel level, std::string_view message) {
  return Dump({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::string MessageDataHead(std::uint32_t subscription, std::int64_t received_ns) {
  std::string head(1, kMessageData);
  PutNumber(head, subscription, 4);
  PutNumber(head, static_cast<std::uint64_t>(received_ns), 8);
  return head;
}

std::string ServiceAnswer(std::uint32_t service, std::uint32_t call, std::string_view json_text) {
  constexpr std::string_view kEncoding = "json";
  std::string answer(1, kServiceResponse);
  PutNumber(answer, service, 4);
  PutNumber(answer, call, 4);
  PutNumber(answer, kEncoding.size(), 4);
  answer += kEncoding;
  return answer += json_text;
}

std::string ServiceFailureText(std::uint32_t service,
                               std::uint32_t call,
                               std::string_view message) {
  return Dump({{"op", "serviceCallFailure"},
               {"serviceId", service},
               {"callId", call},
               {"message", message}});
}

std::optional<ClientMessage> ParseClientText(std::string_view text) {
  // No exceptions are used: invalid JSON becomes a discarded value, which is no object.
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object() || !Member(message, "op").is_string()) return std::nullopt;
  const std::string op = message["op"];
  if (op == "subscribe") return ParseSubscribe(message);
  if (op == "unsubscribe") return ParseUnsubscribe(message);
  return NotOffered{op};
}

std::optional<ClientMessage> ParseClientBinary(std::string_view bytes) {
  constexpr std::size_t kHead = 13;  // opcode, service, call, and length of the encoding's name
  if (!bytes.empty() && bytes[0] == kClientMessageData) return NotOffered{"publishing"};
  if (bytes.size() < kHead || bytes[0] != kServiceRequest) return std::nullopt;
  const std::uint32_t length = NumberAt(bytes, 9);
  if (length > bytes.size() - kHead) return std::nullopt;
  if (bytes.substr(kHead, length) != "json") return NotOffered{"services without JSON"};
  return ServiceCall{
      NumberAt(bytes, 1), NumberAt(bytes, 5), std::string(bytes.substr(kHead + length))};
}

}  // namespace plumbline
