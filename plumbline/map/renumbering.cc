// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/renumbering.h"

#include "plumbline/map/map_builder.h"

#include <cstddef>
#include <map>
#include <utility>

namespace plumbline {
namespace {

template <class SomeId>
std::map<SomeId, SomeId> Renumbered(const std::map<SomeId, SomeId>& merged,
                                    const IdOffsets& offsets) {
  std::map<SomeId, SomeId> renumbered;
  for (const auto& [gone, kept] : merged) renumbered.emplace(offsets(gone), offsets(kept));
  return renumbered;
}

MapRecord Renumbered(const MapRecord& original, const IdOffsets& offsets) {
  MapRecord record = original;
  record.id = offsets(original.id);
  record.next_keyframe = offsets(original.next_keyframe);
  record.next_point = offsets(original.next_point);
  record.next_line = offsets(original.next_line);
  record.removed_keyframes.clear();
  for (const auto& [id, removed] : original.removed_keyframes) {
    RemovedKeyFrame& copy = record.removed_keyframes[offsets(id)];
    copy = removed;
    copy.parent = offsets(removed.parent);
  }
  record.merged_points = Renumbered(original.merged_points, offsets);
  record.merged_lines = Renumbered(original.merged_lines, offsets);
  return record;
}

KeyFrame Renumbered(const KeyFrame& original, const IdOffsets& offsets) {
  KeyFrame keyframe = original;
  keyframe.id = offsets(original.id);
  keyframe.parent = offsets(original.parent);
  keyframe.session = offsets(original.session);
  return keyframe;
}

template <class Landmark>
Landmark RenumberedLandmark(const Landmark& original, const IdOffsets& offsets) {
  Landmark landmark = original;
  landmark.id = offsets(original.id);
  landmark.created_by = offsets(original.created_by);
  landmark.observations = {};
  for (const auto& [keyframe, feature] : original.observations) {
    landmark.observations.emplace(offsets(keyframe), feature);
  }
  return landmark;
}

}  // namespace

SessionId IdOffsets::operator()(SessionId id) const {
  const auto place = static_cast<std::size_t>(id.value);
  return id.valid() && place < sessions.size() ? sessions[place] : id;
}

IdOffsets Behind(const Map& map) {
  return {map.id().value + 1,
          map.NextKeyFrameId().value,
          map.NextPointId().value,
          map.NextLineId().value,
          {}};
}

Map Renumbered(const Map& map, const IdOffsets& offsets) {
  MapBuilder builder(Renumbered(map.Record(), offsets), "a map behind others");
  for (const auto& [id, keyframe] : map.keyframes()) builder.Add(Renumbered(keyframe, offsets));
  for (const auto& [id, point] : map.points()) builder.Add(RenumberedLandmark(point, offsets));
  for (const auto& [id, line] : map.lines()) builder.Add(RenumberedLandmark(line, offsets));
  return builder.Finish();
}

}  // namespace plumbline
