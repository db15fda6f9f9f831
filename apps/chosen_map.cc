// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/chosen_map.h"

#include "plumbline/base/error.h"

namespace plumbline {

Map& ChooseMap(const CommandLine& line, Atlas& atlas) {
  constexpr int kMostMaps = 1'000'000'000;
  if (atlas.empty()) throw InputError(line.Positional(0) + ": expected a map, found none");
  if (!line.Has("--map")) return atlas.Activate(atlas.active_id());
  const MapId id{line.Count("--map", 0, {0, kMostMaps})};
  if (atlas.Find(id) == nullptr) {
    throw InputError("--map " + *line.Value("--map") +
                     ": expected a map of the file; see map info");
  }
  return atlas.Activate(id);
}

}  // namespace plumbline
