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

AtlasContext ContextOf(const System& system) {
  const SlamOptions& options = system.options();
  const LocalMapper::State mapper = system.mapper_state();
  AtlasContext context;
  context.camera = system.camera();
  context.rectified_from_left = system.rectifier().rectified_left_from_left();
  context.octave_scale = options.features.orb.scale_factor;
  context.calibration = FingerprintOf(system.rectifier().calibration(), system.camera());
  context.stereo_evidence = mapper.stereo_evidence;
  context.front_end = FingerprintOf(options.features);
  context.options_yaml = ResultOptionsYaml(options);
  context.sessions = {system.session()};
  for (const auto& [id, map] : system.maps()) {
    context.maps[id].uuid =
        UuidOf(ToString(context.sessions[0].uuid) + " map " + std::to_string(id.value));
  }
  if (!system.maps().empty()) context.maps[system.atlas().active_id()].young = mapper.young;
  return context;
}

}  // namespace plumbline
