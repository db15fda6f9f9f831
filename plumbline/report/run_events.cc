// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_events.h"

#include <algorithm>

namespace plumbline {
namespace {

// Finds keyframes, removed ones included, in the world that is shown.
struct Whereabouts {
  const std::map<MapId, Map>& maps;
  const std::map<MapId, Similarity3>& world_from_map;

  const Map* MapOf(KeyFrameId id) const {
    for (const auto& [map_id, map] : maps) {
      if (id.valid() && map.Knows(id)) return &map;
    }
    return nullptr;
  }

  std::optional<Eigen::Vector3d> Of(KeyFrameId id) const {
    const Map* map = MapOf(id);
    if (map == nullptr) return std::nullopt;
    return world_from_map.at(map->id()) * Inverse(map->PoseOf(id)).translation;
  }
};

RunEvent Placed(RunEventKind kind, const Recognition& place, const Whereabouts& whereabouts) {
  RunEvent event;
  event.kind = kind;
  event.place = place;
  if (const Map* map = whereabouts.MapOf(place.older)) event.map = map->id();
  event.at = whereabouts.Of(place.keyframe);
  event.older_at = whereabouts.Of(place.older);
  return event;
}

}  // namespace

std::vector<RunEvent> PlaceEvents(const MapEvents& events,
                                  const std::map<MapId, Map>& maps,
                                  const std::map<MapId, Similarity3>& world_from_map) {
  const Whereabouts whereabouts{maps, world_from_map};
  std::vector<RunEvent> placed;
  for (const Recognition& loop : events.loops) {
    placed.push_back(Placed(RunEventKind::kLoop, loop, whereabouts));
  }
  for (const MapJoin& join : events.joins) {
    placed.push_back(Placed(RunEventKind::kJoin, join.place, whereabouts));
    placed.back().join = join;
  }
  for (const Relocalization& found : events.relocalizations) {
    Recognition place;
    place.frame = found.frame;
    place.older = found.keyframe;
    place.points = found.points;
    place.lines = found.lines;
    placed.push_back(Placed(RunEventKind::kRelocalization, place, whereabouts));
  }
  std::stable_sort(placed.begin(), placed.end(), [](const RunEvent& a, const RunEvent& b) {
    return a.place.frame < b.place.frame;
  });
  return placed;
}

}  // namespace plumbline
