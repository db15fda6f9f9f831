// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/slam/atlas_places.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// Returns all keyframes of a map.
inline std::vector<KeyFrameId> KeyFramesOf(const Map& map) {
  std::vector<KeyFrameId> ids;
  for (const auto& [id, keyframe] : map.keyframes()) ids.push_back(id);
  return ids;
}

// Returns the answer of an index of the map's keyframes alone.
inline std::vector<KeyFrameId> MostAlikeOf(const Map& map, const Features& features) {
  constexpr std::size_t kMost = 20;
  PlaceIndex index;
  for (const auto& [id, keyframe] : map.keyframes()) index.Add(id, keyframe.frame.features());
  return MostAlike(index, map, features, kMost);
}

}  // namespace plumbline
