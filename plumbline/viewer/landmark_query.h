// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"

#include <cstdint>
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

}  // namespace plumbline
