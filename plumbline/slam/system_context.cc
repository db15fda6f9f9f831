// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// Context of a system's maps for map files.
#include "plumbline/map/byte_format.h"
#include "plumbline/slam/atlas_context.h"
#include "plumbline/slam/system.h"
#include "plumbline/slam/system_stages.h"

namespace plumbline {

Uuid System::SessionUuid(const ExtractedFrame& first) const {
  ByteWriter contents;
  const Eigen::Quaterniond turn = rectifier().rectified_left_from_left();
  const std::string options = ResultOptionsYaml(options_);
  TransferAll(contents, camera(), turn, options, first.stamp_ns, first.indexed->features);
  return UuidOf(contents.bytes());
}

AtlasContext System::ContextWithoutMaps() const {
  AtlasContext context;
  if (loaded_) {
    context.sessions = loaded_->sessions;
    context.maps = loaded_->maps;
  }
  context.camera = camera();
  context.rectified_from_left = rectifier().rectified_left_from_left();
  context.octave_scale = options_.features.orb.scale_factor;
  context.feature_format = kFeatureFormat;
  context.options_yaml = ResultOptionsYaml(options_);
  context.sessions.push_back(session());
  return context;
}

AtlasContext System::Context() const {
  if (loaded_ && read_only_) return *loaded_;
  AtlasContext context = ContextWithoutMaps();
  AddMaps(atlas(), mapping_.mapper_state(), context);
  return context;
}

}  // namespace plumbline
