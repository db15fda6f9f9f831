// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/map/placement.h"
#include "plumbline/slam/mapping_stage.h"

#include <algorithm>
#include <mutex>
#include <utility>

namespace plumbline {

MappingStage::Checkpoint MappingStage::Save() {
  WaitFor(submitted_);
  const std::lock_guard lock(mutex_);
  return {mapper_.state(),
          submitted_,
          map_begins_,
          dues_,
          versions_,
          outcomes_,
          changed_,
          centres_,
          first_places_,
          lens_asked_,
          times_,
          atlas_.history(),
          places_.state(),
          adjustment_.Save()};
}

void MappingStage::Resume(Atlas atlas, const Checkpoint& checkpoint) {
  CheckFits(atlas, checkpoint);
  const std::lock_guard lock(mutex_);
  PLUMBLINE_CHECK(submitted_ == 0 && atlas_.empty(), "a stage goes on before the first keyframe");
  atlas_ = std::move(atlas);
  mapper_.SetState(checkpoint.mapper);
  submitted_ = checkpoint.submitted;
  map_begins_ = checkpoint.map_begins;
  dues_ = checkpoint.dues;
  versions_ = checkpoint.versions;
  outcomes_ = checkpoint.outcomes;
  changed_ = checkpoint.changed;
  centres_ = checkpoint.centres;
  first_places_ = checkpoint.first_places;
  lens_asked_ = checkpoint.lens_asked;
  times_ = checkpoint.times;
  places_.SetState(checkpoint.places);
  events_ = {places_.loops(), places_.joins(), {}};
  places_.Follow(atlas_);
  adjustment_.Resume(checkpoint.adjustment);
}

// Throws InputError where a stage cannot go on from the checkpoint: its tasks must all be done, and
// refer to these maps.
void MappingStage::CheckFits(const Atlas& atlas, const Checkpoint& c) {
  const auto ascend = [&](const auto& items) {
    std::int64_t before = -1;
    for (const auto& item : items) {
      if (item.task <= before || item.task > c.submitted) return false;
      before = item.task;
    }
    return true;
  };
  const auto has = [&](MapId id) { return atlas.Find(atlas.Current(id)) != nullptr; };
  bool fits = ascend(c.dues) && ascend(c.versions) && ascend(c.outcomes) && c.submitted >= 0;
  fits = fits && !c.versions.empty() && c.versions.back().task == c.submitted;
  for (const Outcome& outcome : c.outcomes) {
    const auto& [found, snapshot] = outcome.outcome;
    fits = fits && found.has_value() == (snapshot != nullptr);
    fits = fits && (snapshot == nullptr || has(snapshot->map));
  }
  for (const MapId id : c.changed) fits = fits && atlas.Find(id) != nullptr;
  for (const auto& [id, place] : c.first_places) {
    const Map* map = atlas.Find(id);
    fits = fits && map != nullptr && map->Knows(place.id) && IsPose(place.cam_from_world);
  }
  for (const auto& [id, taken_in] : c.lens_asked) fits = fits && atlas.Find(id) != nullptr;
  for (const KeyFrameId id : c.centres) {  // of any map: a lost camera was looked for in all
    fits = fits && std::any_of(atlas.maps().begin(), atlas.maps().end(), [&](const auto& map) {
             return map.second.Knows(id);
           });
  }
  fits = fits && (!c.adjustment || has(c.adjustment->result.map));
  if (c.adjustment && c.adjustment->result.correction.lens) {
    fits = fits && c.adjustment->result.correction.lens->IsPlausible();
  }
  if (const auto& change = c.mapper.stereo_change) {
    fits = fits && atlas.Find(change->map) != nullptr && change->correction.IsFinite();
  }
  if (!fits) throw InputError("expected tasks and maps that agree, found others");
}

}  // namespace plumbline
