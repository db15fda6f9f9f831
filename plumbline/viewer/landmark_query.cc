// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/landmark_query.h"

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

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
