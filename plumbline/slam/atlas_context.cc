// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/atlas_context.h"

#include "plumbline/base/options_io.h"
#include "plumbline/geometry/calibration_fingerprint.h"
#include "plumbline/map/byte_format.h"
#include "plumbline/slam/system.h"

namespace plumbline {

std::string ResultOptionsYaml(const SlamOptions& options) {
  SlamOptions copy = options;
  if (copy.slam.mode == RunMode::kInline) copy.slam.mode = RunMode::kLockstep;
  copy.features.parallel = FeatureOptions().parallel;
  return OptionTable(copy).Dump();
}

Uuid SessionUuid(const System& system, const MeasuredFrame& first) {
  ByteWriter contents;
  const std::uint64_t rig = FingerprintOf(system.rectifier().calibration(), system.camera());
  const std::string options = ResultOptionsYaml(system.options());
  TransferAll(contents, rig, options, first.stamp_ns, first.indexed->features);
  return UuidOf(contents.bytes());
}

AtlasContext ContextWithoutMaps(const System& system) {
  const SlamOptions& options = system.options();
  AtlasContext context;
  if (const AtlasContext* loaded = system.loaded()) {
    context.sessions = loaded->sessions;
    context.maps = loaded->maps;
  }
  context.camera = system.camera();
  context.rectified_from_left = system.rectifier().rectified_left_from_left();
  context.octave_scale = options.features.orb.scale_factor;
  context.calibration = FingerprintOf(system.rectifier().calibration(), system.camera());
  context.front_end = FingerprintOf(options.features);
  context.options_yaml = ResultOptionsYaml(options);
  context.sessions.push_back(system.session());
  return context;
}

void AddMaps(const Atlas& atlas, const LocalMapper::State& mapper, AtlasContext& context) {
  context.stereo_evidence = mapper.stereo_evidence;
  const std::string session = ToString(context.sessions.back().uuid);
  for (const auto& [id, map] : atlas.maps()) {
    Uuid& uuid = context.maps[id].uuid;
    if (uuid == Uuid()) uuid = UuidOf(session + " map " + std::to_string(id.value));
  }
  if (!atlas.empty()) context.maps[atlas.active_id()].young = mapper.young;
}

AtlasContext ContextOf(const System& system) {
  if (system.loaded() != nullptr && system.read_only()) return *system.loaded();
  AtlasContext context = ContextWithoutMaps(system);
  AddMaps(system.atlas(), system.mapper_state(), context);
  return context;
}

}  // namespace plumbline
