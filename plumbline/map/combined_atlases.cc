// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/combined_atlases.h"

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map_builder.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// Returns the sessions of an atlas. Files that know no sessions have one without a name.
std::vector<Session> SessionsOf(const AtlasContext& context) {
  if (!context.sessions.empty()) return context.sessions;
  return {Session()};
}

// Adds the sessions of another atlas. Returns for each of its sessions the id that it has now.
std::vector<SessionId> AddSessions(const std::vector<Session>& added,
                                   std::vector<Session>& sessions) {
  std::vector<SessionId> names;
  for (const Session& session : added) {
    const auto same = std::find_if(sessions.begin(), sessions.end(), [&](const Session& other) {
      return other.uuid == session.uuid && session.uuid != Uuid();
    });
    names.push_back(SessionId{same - sessions.begin()});
    if (same == sessions.end()) sessions.push_back(session);
  }
  return names;
}

IdOffsets BehindAll(const Atlas& atlas) {
  IdOffsets offsets;
  offsets.maps = atlas.NextMapId().value;
  offsets.keyframes = atlas.NextKeyFrameId().value;
  for (const auto& [id, map] : atlas.maps()) {
    offsets.points = std::max(offsets.points, map.NextPointId().value);
    offsets.lines = std::max(offsets.lines, map.NextLineId().value);
  }
  return offsets;
}

template <class LandmarkId>
void AddBehind(const std::vector<LandmarkId>& added,
               const IdOffsets& offsets,
               std::vector<LandmarkId>& all) {
  for (const LandmarkId id : added) all.push_back(offsets(id));
}

void Add(const LandmarkIds& added, const IdOffsets& offsets, LandmarkIds& young) {
  AddBehind(added.points, offsets, young.points);
  AddBehind(added.lines, offsets, young.lines);
}

bool IsSameCamera(const AtlasContext& a, const AtlasContext& b) {
  return !CameraDifference({a.camera, a.rectified_from_left}, {b.camera, b.rectified_from_left});
}

void Add(const StereoEvidence& added, StereoEvidence& evidence) {
  evidence.information += added.information;
  evidence.weighted += added.weighted;
  evidence.moments += added.moments;
}

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

CombinedAtlases CombineAtlases(SavedAtlas first, const SavedAtlas& second) {
  CombinedAtlases gathered{std::move(first), {}};
  Atlas& atlas = gathered.saved.atlas;
  AtlasContext& context = gathered.saved.context;
  IdOffsets offsets = BehindAll(atlas);
  context.sessions = SessionsOf(context);
  const std::size_t sessions_of_first = context.sessions.size();
  offsets.sessions = AddSessions(SessionsOf(second.context), context.sessions);
  const bool of_other_sessions =
      context.sessions.size() == sessions_of_first + offsets.sessions.size();
  if (of_other_sessions && IsSameCamera(context, second.context)) {
    Add(second.context.stereo_evidence, context.stereo_evidence);
  }
  for (const auto& [id, map] : second.atlas.maps()) atlas.Adopt(Renumbered(map, offsets));
  for (const auto& [id, of_map] : second.context.maps) {
    MapContext& added = context.maps[offsets(id)];
    added.uuid = of_map.uuid;
    Add(of_map.young, offsets, added.young);
  }
  gathered.second = offsets(second.atlas.active_id());
  return gathered;
}

void SettleJoined(SavedAtlas& saved) {
  for (const auto& [gone, kept] : saved.atlas.joined()) {
    const auto of_gone = saved.context.maps.find(gone);
    if (of_gone == saved.context.maps.end()) continue;
    const LandmarkIds young = std::move(of_gone->second.young);
    saved.context.maps.erase(of_gone);
    Add(young, IdOffsets(), saved.context.maps[saved.atlas.Current(gone)].young);
  }
}

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
