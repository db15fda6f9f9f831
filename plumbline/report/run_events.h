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

// A place that was seen again, for display.
struct RunEvent {
  RunEventKind kind = RunEventKind::kLoop;
  // What was recognized. Of a relocalization the frame, the keyframe that showed the way as
  // `older`, points and lines alone.
  Recognition place;
  std::optional<MapJoin> join;
  std::optional<MapId> map;  // that has the older keyframe in the end; nullopt: none has it
  // Where both keyframes are in the end, in the world shown. `at` is not said of a relocalization:
  // it is where the frame is.
  std::optional<Eigen::Vector3d> at, older_at;
};

// The events of a run in the order of their frames, with their places in the world that is shown.
//
//   world_from_map  by map: how it is shown
std::vector<RunEvent> PlaceEvents(const MapEvents& events,
                                  const std::map<MapId, Map>& maps,
                                  const std::map<MapId, Similarity3>& world_from_map);

}  // namespace plumbline
