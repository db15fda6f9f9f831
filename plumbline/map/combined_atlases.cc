// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/combined_atlases.h"

#include "plumbline/geometry/camera_difference.h"
#include "plumbline/map/renumbering.h"

#include <algorithm>
#include <cstdint>
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

void Add(const RecentLandmarks& added, const IdOffsets& offsets, RecentLandmarks& young) {
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
    const RecentLandmarks young = std::move(of_gone->second.young);
    saved.context.maps.erase(of_gone);
    Add(young, IdOffsets(), saved.context.maps[saved.atlas.Current(gone)].young);
  }
}

}  // namespace plumbline
