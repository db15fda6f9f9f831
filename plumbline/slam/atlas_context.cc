// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/atlas_context.h"

#include "plumbline/base/options_io.h"

namespace plumbline {

std::string ResultOptionsYaml(const SlamOptions& options) {
  SlamOptions copy = options;
  if (copy.slam.mode == RunMode::kInline) copy.slam.mode = RunMode::kLockstep;
  copy.features.parallel = FeatureOptions().parallel;
  return OptionTable(copy).Dump();
}

void AddMaps(const Atlas& atlas, const LocalMapper::State& mapper, AtlasContext& context) {
  // A map that was loaded may be part of another one by now.
  std::erase_if(context.maps,
                [&](const auto& of_map) { return atlas.Find(of_map.first) == nullptr; });
  context.stereo_evidence = mapper.stereo_evidence;
  const std::string session = ToString(context.sessions.back().uuid);
  for (const auto& [id, map] : atlas.maps()) {
    Uuid& uuid = context.maps[id].uuid;
    if (uuid == Uuid()) uuid = UuidOf(session + " map " + std::to_string(id.value));
  }
  for (const auto& [id, young] : mapper.young) {
    if (atlas.Find(id) != nullptr) context.maps[id].young = young;
  }
}

std::map<MapId, LandmarkIds> YoungOf(const AtlasContext& context) {
  std::map<MapId, LandmarkIds> young;
  for (const auto& [id, of_map] : context.maps) young[id] = of_map.young;
  return young;
}

}  // namespace plumbline
