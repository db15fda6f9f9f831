// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// Functions of System about its maps: context for map files, reading maps, the result of the run.
#include "plumbline/base/error.h"
#include "plumbline/map/byte_format.h"
#include "plumbline/slam/atlas_context.h"
#include "plumbline/slam/system.h"
#include "plumbline/slam/system_stages.h"
#include "plumbline/version.h"

#include <string>
#include <utility>

namespace plumbline {

void System::BeginResult() {
  result_.options = options_;
  result_.camera = rectifier().camera();
  result_.rectified_from_left = rectifier().rectified_left_from_left();
  AtlasContext& context = result_.context;
  context.camera = result_.camera;
  context.rectified_from_left = result_.rectified_from_left;
  context.octave_scale = options_.features.orb.scale_factor;
  context.feature_format = kFeatureFormat;
  context.options_yaml = ResultOptionsYaml(options_);
  context.sessions.emplace_back().program = PLUMBLINE_VERSION;
}

void System::NameSession(const ExtractedFrame& first) {
  ByteWriter contents;
  AtlasContext& context = result_.context;
  TransferAll(contents,
              context.camera,
              context.rectified_from_left,
              context.options_yaml,
              first.stamp_ns,
              first.indexed->features);
  context.sessions.back().uuid = UuidOf(contents.bytes());
}

SessionId System::session_id() const {
  return SessionId{static_cast<std::int64_t>(result_.context.sessions.size()) - 1};
}

void System::ReadMaps(std::function<void(const CurrentMaps&)> read) {
  PLUMBLINE_CHECK(!finished_, "the maps of a finished run are in its result");
  Complete();
  const auto read_all =
      [this, context = result_.context, read_only = result_.read_only, read = std::move(read)](
          const Atlas& atlas, const LocalMapper& mapper, const PlaceRecognition& places) {
        const auto copy = [&] {
          SavedAtlas copied{atlas, context};
          if (!read_only) AddMaps(atlas, mapper.state(), copied.context);
          mapping_.MoveFirstKeyFramesBack(copied.atlas);
          return copied;
        };
        read({atlas, {places.loops(), places.joins(), {}}, copy});
      };
  mapping_.Submit(newest_.id.value, MapReader{read_all});
}

void System::CollectMaps() {
  result_.atlas = mapping_.TakeAtlas();
  result_.adjusted_lines = mapping_.adjusted_lines();
  MapEvents events = mapping_.events();
  result_.events.loops = std::move(events.loops);
  result_.events.joins = std::move(events.joins);
  if (!result_.read_only) AddMaps(result_.atlas, mapping_.mapper_state(), result_.context);
  auto& counts = result_.step_counts;
  counts["cut_lines"] = cut_lines_;
  if (!monocular_initialization_) return;
  const InitializationCounts& start = monocular_initialization_->counts();
  counts["start_aligned_images"] = start.aligned_images;
  counts["start_model_selections"] = start.model_selections;
  counts["start_pairwise_poses"] = start.pairwise_poses;
  counts["start_pairwise_factorizations"] = start.pairwise_factorizations;
  counts["start_interpolated_places"] = start.interpolated_places;
  counts["start_two_view_solutions"] = start.two_view_solutions;
}

}  // namespace plumbline
