// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/view_clients.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

// Services are numbered from 1 on.
constexpr std::uint32_t kLandmarkService = 1, kPauseService = 2, kStepService = 3;
constexpr std::array<FoxgloveService, 3> kServices = {
    {{"/plumbline/landmark", "plumbline/Landmark"},
     {"/plumbline/pause", "plumbline/Pause"},
     {"/plumbline/step", "plumbline/Step"}}};

std::int64_t SteadyNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

// Parses {"paused": true}.
std::optional<bool> ParsePause(std::string_view text) {
  const nlohmann::json request = nlohmann::json::parse(text, nullptr, false);
  if (!request.is_object()) return std::nullopt;
  const auto it = request.find("paused");
  if (it == request.end() || !it->is_boolean()) return std::nullopt;
  return it->get<bool>();
}

using nlohmann::json;

json PixelsOf(const Features& features, bool is_line, std::size_t feature) {
  if (!is_line) {
    const Eigen::Vector2d& px = features.points.at(feature).px;
    return {px.x(), px.y()};
  }
  const Segment2& segment = features.lines.at(feature).segment;
  return {segment.start.x(), segment.start.y(), segment.end.x(), segment.end.y()};
}

json SeenBy(const Map& map, const Observations& observations, bool is_line) {
  json list = json::array();
  for (const auto& [id, feature] : observations) {
    const KeyFrame* keyframe = map.Find(id);
    if (keyframe == nullptr) continue;
    list.push_back({{"keyframe", id.value},
                    {"frame", keyframe->frame.id.value},
                    {"px",
                     PixelsOf(MeasuredFeatures(*keyframe->frame.indexed),
                              is_line,
                              static_cast<std::size_t>(feature))}});
  }
  return list;
}

}  // namespace

ViewClients::ViewClients(ViewState& state,
                         const std::string& name,
                         bool can_pause,
                         ViewActions actions)
    : state_(state),
      can_pause_(can_pause),
      actions_(std::move(actions)),
      hello_(ServerInfoText("Plumbline: " + name, MakeWebToken())),
      channels_(AdvertiseText(FoxgloveChannels(), FoxgloveSchemas())),
      services_(AdvertiseServicesText(
          std::span(kServices).first(can_pause ? kServices.size() : kLandmarkService))) {}

void ViewClients::Opened(WebClient& client) {
  clients_[&client].number = next_number_++;
  client.SendText(hello_);
  client.SendText(channels_);
  client.SendText(services_);
}

void ViewClients::Received(WebClient& client, std::string_view message, bool binary) {
  if (!clients_.contains(&client)) return;
  const auto parsed = binary ? ParseClientBinary(message) : ParseClientText(message);
  if (!parsed) {
    client.SendText(StatusText(StatusLevel::kError, "no message of the protocol"));
    return;
  }
  std::visit([&](const auto& known) { Do(client, known); }, *parsed);
}

void ViewClients::Do(WebClient& client, const Subscribe& message) {
  Viewer& viewer = clients_.at(&client);
  std::string_view problem;
  for (const auto& [id, channel] : message.subscriptions) {
    if (channel == 0 || channel > kStreams) {
      problem = "no such channel";
    } else if (viewer.subscriptions[channel - 1]) {
      problem = "already subscribed to this channel";
    } else {
      viewer.subscriptions[channel - 1] = id;
    }
  }
  if (!problem.empty()) client.SendText(StatusText(StatusLevel::kError, problem));
  Serve(client);
}

void ViewClients::Do(WebClient& client, const Unsubscribe& message) {
  Viewer& viewer = clients_.at(&client);
  for (std::size_t i = 0; i < kStreams; ++i) {
    auto& subscription = viewer.subscriptions[i];
    if (!subscription) continue;
    const auto& ids = message.ids;
    if (std::find(ids.begin(), ids.end(), *subscription) == ids.end()) continue;
    subscription.reset();
    // A client that subscribes again has nothing.
    viewer.cursor.frame[i] = 0;
    if (i == static_cast<std::size_t>(Stream::kPoints)) viewer.cursor.points = 0;
    if (i == static_cast<std::size_t>(Stream::kLines)) viewer.cursor.lines = 0;
    if (i == static_cast<std::size_t>(Stream::kUpdates)) {
      viewer.cursor.map = 0;
      viewer.cursor.events = 0;
    }
  }
}

void ViewClients::Do(WebClient& client, const ServiceCall& message) {
  const CallId id{clients_.at(&client).number, message.service, message.call};
  const auto fail = [&](std::string_view why) {
    client.SendText(ServiceFailureText(message.service, message.call, why));
  };
  if (message.service == kLandmarkService) {
    const auto question = ParseMapQuestion(message.json);
    if (!question) return fail(R"(expected {"point": ID} or {"line": ID})");
    if (!actions_.ask(id, *question)) fail("too many questions wait for an answer");
    return;
  }
  if (!can_pause_ || message.service > kStepService || message.service == 0) {
    return fail("no such service");
  }
  if (message.service == kPauseService) {
    const auto paused = ParsePause(message.json);
    if (!paused) return fail(R"(expected {"paused": true or false})");
    actions_.pause(*paused);
  } else {
    actions_.step();
  }
  Answer(id, "{}");
}

void ViewClients::Do(WebClient& client, const NotOffered& message) {
  client.SendText(StatusText(StatusLevel::kWarning, "not offered here: " + message.what));
}

void ViewClients::Answer(const CallId& id, const std::string& json) {
  for (auto& [client, viewer] : clients_) {
    if (viewer.number != id.client) continue;
    const auto nothing = std::make_shared<const std::string>();
    client->SendBinary(ServiceAnswer(id.service, id.call, json), nothing);
    return;
  }
}

void ViewClients::Serve(WebClient& client) {
  const auto it = clients_.find(&client);
  if (it == clients_.end() || client.waiting() > 0) return;
  Viewer& viewer = it->second;
  const auto now = Clock::now();
  if (now < viewer.next) return actions_.wake_at(viewer.next);
  for (unsigned i = 0; i < kStreams; ++i) {
    if (!viewer.subscriptions[i]) continue;
    const SharedBytes message = state_.Next(static_cast<Stream>(i), viewer.cursor, SteadyNs());
    if (message == nullptr) continue;
    viewer.next = now + kBetweenMessages;
    client.SendBinary(MessageDataHead(*viewer.subscriptions[i], state_.stamp_ns()), message);
    if (!clients_.contains(&client)) return;  // sending closed the client
  }
}

void ViewClients::ServeAll() {
  std::vector<WebClient*> all;
  for (const auto& entry : clients_) all.push_back(entry.first);
  for (WebClient* client : all) Serve(*client);
}

bool ViewClients::IsWanted(Stream stream) const {
  return std::any_of(clients_.begin(), clients_.end(), [&](const auto& entry) {
    return entry.second.subscriptions[static_cast<std::size_t>(stream)].has_value();
  });
}

bool ViewClients::frames_wanted() const {
  return std::any_of(clients_.begin(), clients_.end(), [](const auto& entry) {
    const auto& subscriptions = entry.second.subscriptions;
    return std::any_of(subscriptions.begin(), subscriptions.end(), [](const auto& subscription) {
      return subscription.has_value();
    });
  });
}

bool ViewClients::map_wanted() const {
  return IsWanted(Stream::kPoints) || IsWanted(Stream::kLines) || IsWanted(Stream::kUpdates);
}

bool ViewClients::all_served() const {
  return std::all_of(clients_.begin(), clients_.end(), [](const auto& entry) {
    return entry.first->waiting() == 0 && entry.second.next <= Clock::now();
  });
}

std::optional<MapQuestion> ParseMapQuestion(std::string_view text) {
  const json question = json::parse(text, nullptr, false);
  if (!question.is_object()) return std::nullopt;
  for (const bool is_line : {false, true}) {
    const auto it = question.find(is_line ? "line" : "point");
    if (it == question.end()) continue;
    if (!it->is_number_integer()) return std::nullopt;
    return MapQuestion{is_line, it->get<std::int64_t>()};
  }
  return std::nullopt;
}

std::string AnswerMapQuestion(const Atlas& atlas, const MapQuestion& question) {
  json seen_by = json::array();
  if (!atlas.empty() && atlas.active_id().valid()) {
    const Map& map = atlas.active();
    if (question.is_line) {
      const MapLine* line = map.Find(LineId{question.id});
      if (line != nullptr) seen_by = SeenBy(map, line->observations, true);
    } else {
      const MapPoint* point = map.Find(PointId{question.id});
      if (point != nullptr) seen_by = SeenBy(map, point->observations, false);
    }
  }
  return json{{question.is_line ? "line" : "point", question.id}, {"seen_by", std::move(seen_by)}}
      .dump();
}

}  // namespace plumbline
