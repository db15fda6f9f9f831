// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/map/map.h"
#include "plumbline/slam/map_events.h"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

enum class RunEventKind { kLoop, kJoin, kRelocalization };
constexpr auto EnumNames(std::type_identity<RunEventKind>) {
  return std::array{std::pair{RunEventKind::kLoop, "loop"},
                    std::pair{RunEventKind::kJoin, "join"},
                    std::pair{RunEventKind::kRelocalization, "relocalization"}};
}

// An event of a run, for display.
struct RunEvent {
  RunEventKind kind = RunEventKind::kLoop;
  // The recognized place. For a relocalization it has only the frame, points, lines, and as `older`
  // the matched keyframe.
  Recognition place;
  std::optional<MapJoin> join;
  // Final map of the older keyframe; nullopt if it has left all maps.
  std::optional<MapId> map;
  // Final positions of both keyframes in the displayed world. A relocalization has no `at`: it is
  // at its frame.
  std::optional<Eigen::Vector3d> at, older_at;
};

// Returns the events of a run in the order of their frames, with their positions in the displayed
// world.
//
//   world_from_map  pose of each map in the displayed world
std::vector<RunEvent> PlaceEvents(const MapEvents& events,
                                  const std::map<MapId, Map>& maps,
                                  const std::map<MapId, Similarity3>& world_from_map);

}  // namespace plumbline
