// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// System::Save and System::Resume.
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/geometry/calibration_fingerprint.h"
#include "plumbline/geometry/camera_difference.h"
#include "plumbline/map/state_format.h"
#include "plumbline/slam/atlas_context.h"
#include "plumbline/slam/byte_format.h"
#include "plumbline/slam/system_stages.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr const char* kSource = "state of the run";

std::span<const std::uint8_t> BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Throws InputError where an option that decides about the results differs from the saved one.
void CheckOptionsAgree(const std::string& saved_yaml, const SlamOptions& options) {
  SlamOptions before, now;
  OptionTable saved(before), given(now);
  saved.LoadText(saved_yaml, "options of the checkpoint");
  given.LoadText(ResultOptionsYaml(options), "options");
  for (const std::string& key : given.Keys()) {
    if (saved.Value(key) == given.Value(key)) continue;
    throw InputError(fmt::format(
        "{}: expected {} as in the checkpoint, found {}", key, saved.Value(key), given.Value(key)));
  }
}

void CheckRigAgrees(const AtlasContext& saved, const Rectifier& rectifier) {
  if (const auto difference = CameraDifference({saved.camera}, {rectifier.camera()})) {
    throw InputError("expected a checkpoint of the same rectified camera, found " + *difference);
  }
  if (saved.calibration != FingerprintOf(rectifier.calibration(), rectifier.camera())) {
    throw InputError("expected a checkpoint of the same calibration, found one of another");
  }
}

[[noreturn]] void Fail(const std::string& what) {
  throw InputError(std::string(kSource) + ": expected one that agrees with itself, found " + what);
}

// Restores which maps took others in. BugError becomes InputError, because the bytes are at fault
// and not the program.
void RestoreHistory(const Atlas::History& history, Atlas& atlas) {
  try {
    atlas.SetHistory(history);
  } catch (const BugError& error) {
    Fail(error.what());
  }
}

// Completes the mapper's state by what the maps' own context holds of it.
LocalMapper::State MapperOf(const SavedAtlas& maps, LocalMapper::State mapper) {
  mapper.stereo_evidence = maps.context.stereo_evidence;
  mapper.young = YoungOf(maps.context);
  return mapper;
}

}  // namespace

template <class Checkpoint>
void System::CheckResumed(const Atlas& atlas, const Checkpoint& stage) const {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const FrameRecord record = frames_[i];
    if (record.status != FrameStatus::kTracked) continue;
    const Map* map = atlas.Find(atlas.Current(record.map));
    if (map == nullptr || !map->Knows(record.reference)) Fail("a frame without its keyframe");
  }
  // Maps that do not grow are all alike to a camera that is found in one of them.
  const MapId map = atlas.Current(map_);
  const bool follows =
      atlas.empty() || (read_only_ ? atlas.Find(map) != nullptr : map == atlas.active_id());
  if (next_map_ != stage.history.next_map.value || !follows) {
    Fail("other maps");
  }
  if (tracker_.next_keyframe() < atlas.NextKeyFrameId()) Fail("keyframes that are to come");
  if (stage.versions.empty() || (tracker_.follows() && stage.versions.back().snapshot == nullptr)) {
    Fail("a camera that is tracked without a map");
  }
}

SavedRun System::Save() {
  Complete();
  const MappingStage::Checkpoint stage = mapping_.Save();
  SavedRun saved{{mapping_.atlas(), ContextWithoutMaps()}, {}, {}};
  AddMaps(saved.maps.atlas, stage.mapper, saved.maps.context);
  StateWriter state;
  Transfer(state, stage);
  VisitRest(*this, [&](const auto&... fields) { TransferAll(state, fields...); });
  if (monocular_start_) monocular_start_->Save(state);
  saved.state = state.Take();
  return saved;
}

void System::Resume(SavedRun saved) {
  PLUMBLINE_CHECK(frames_.empty() && !loaded_, "a run goes on before its first frame");
  CheckRigAgrees(saved.maps.context, rectifier());
  CheckOptionsAgree(saved.maps.context.options_yaml, options_);
  StateReader state(BytesOf(saved.state), kSource, camera());
  MappingStage::Checkpoint stage;
  Transfer(state, stage);
  stage.mapper = MapperOf(saved.maps, stage.mapper);
  RestoreHistory(stage.history, saved.maps.atlas);
  VisitRest(*this, [&](auto&... fields) { TransferAll(state, fields...); });
  if (monocular_start_) monocular_start_->Load(state, saved.maps.atlas);
  if (state.remaining() != 0) Fail("more bytes");
  if (!frames_.empty()) newest_ = frames_.back();
  CheckResumed(saved.maps.atlas, stage);
  mapping_.Resume(std::move(saved.maps.atlas), stage);
}

}  // namespace plumbline
