// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/match_lines.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/landmark_creation.h"
#include "plumbline/matching/line_matching.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

constexpr int kClosest = 3;  // most keyframes with which lines are made, as in section 3.3

// Unmatched line features of a frame, with their indices in the frame.
struct FreeLines {
  std::vector<LineFeature> features;
  std::vector<std::size_t> index;

  explicit FreeLines(const Frame& frame) {
    for (std::size_t i = 0; i < frame.lines.size(); ++i) {
      if (frame.lines[i].valid()) continue;
      features.push_back(frame.features().lines[i]);
      index.push_back(i);
    }
  }
};

}  // namespace

MapEdit CreateLinesFromViews(const Map& map,
                             const CameraAndPyramid& imaging,
                             KeyFrameId id,
                             const LineSettings& lines) {
  const Frame& frame = map.Find(id)->frame;
  const FreeLines mine(frame);
  // Views of each track, by feature of this keyframe.
  std::map<std::size_t, std::vector<LineViewOf>> tracks;
  for (const auto& neighbour : ClosestCovisible(map, id, kClosest)) {
    const Frame& other = map.Find(neighbour.id)->frame;
    const FreeLines theirs(other);
    const LineMatchOptions matching = LineMatchingOf(
        lines, other.cam_from_world.rotation * frame.cam_from_world.rotation.conjugate());
    for (const FeatureMatch& match : MatchLines(mine.features, theirs.features, matching)) {
      auto& track = tracks[mine.index[static_cast<std::size_t>(match.a)]];
      if (track.empty()) track.push_back({id, mine.index[static_cast<std::size_t>(match.a)]});
      track.push_back({neighbour.id, theirs.index[static_cast<std::size_t>(match.b)]});
    }
  }
  MapEdit edit;
  LineId next = map.NextLineId();
  for (const auto& [feature, views] : tracks) {
    std::optional<MapLine> line;
    const auto reconstruct = lines.method.line_from_views;
    if (views.size() > 2) line = reconstruct(map, imaging.camera, views);
    // If three views disagree, pairs are tried: one wrong match spoils all three, but not the pair
    // without it.
    for (std::size_t k = 1; !line && k < views.size(); ++k) {
      line = reconstruct(map, imaging.camera, {views.front(), views[k]});
    }
    if (!line) continue;
    line->id = next;
    line->created_by = id;
    edit.push_back(edit::AddLine{std::move(*line)});
    ++next.value;
  }
  return edit;
}

}  // namespace plumbline
