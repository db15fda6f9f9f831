// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/association/line_information.h"
#include "plumbline/association/line_matching.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/geometry/line_triangulation.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/landmark_creation.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

constexpr int kClosest = 3;  // keyframes that section 3.3 takes
// Between the interpretation planes of a new line: nearer ones leave its depth open.
constexpr double kMinPlaneAngle = 2 * std::numbers::pi / 180;

struct LineViewOf {
  KeyFrameId keyframe;
  std::size_t feature;
};

// The line features of a frame that show no landmark, and their indices in the frame.
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

// All images of a line, left ones and right ones, as views of single cameras.
std::vector<LineView> ImageViews(const Map& map,
                                 const RectifiedCamera& camera,
                                 const std::vector<LineViewOf>& views) {
  std::vector<LineView> images;
  for (const LineViewOf& view : views) {
    const Frame& frame = map.Find(view.keyframe)->frame;
    const LineFeature& feature = frame.features().lines[view.feature];
    images.push_back({frame.cam_from_world, feature.segment, feature.sigma_px});
    if (const auto& right = frame.features().line_right[view.feature]) {
      images.push_back(
          {RightCamera(camera, frame.cam_from_world), right->segment, right->sigma_px});
    }
  }
  return images;
}

std::optional<MapLine> Reconstruct(const Map& map,
                                   const RectifiedCamera& camera,
                                   const std::vector<LineViewOf>& views) {
  const auto triangulated =
      TriangulateLine(camera, ImageViews(map, camera, views), {.min_plane_angle = kMinPlaneAngle});
  if (!triangulated) return std::nullopt;
  MapLine line;
  line.line = triangulated->estimate.line;
  const Frame& first = map.Find(views.front().keyframe)->frame;
  const LineFeature& feature = first.features().lines[views.front().feature];
  const auto interval = TrimToSegment(camera, first.cam_from_world, line.line, feature.segment);
  if (!interval || interval->end <= interval->start) return std::nullopt;
  line.start = interval->start;
  line.end = interval->end;
  line.descriptor = feature.descriptor;
  line.view_direction =
      (line.Interval().Midpoint() - Inverse(first.cam_from_world).translation).normalized();
  for (const LineViewOf& view : views) {
    line.observations.emplace(view.keyframe, static_cast<int>(view.feature));
    line.information +=
        LineInformation(camera, map.Find(view.keyframe)->frame, view.feature, line.line);
  }
  return line;
}

}  // namespace

MapEdit CreateLinesFromViews(const Map& map,
                             const ImagingModel& imaging,
                             KeyFrameId id,
                             const LineOptions& lines) {
  const Frame& frame = map.Find(id)->frame;
  const FreeLines mine(frame);
  std::map<std::size_t, std::vector<LineViewOf>> tracks;  // by feature of this keyframe
  for (const auto& neighbour : ClosestCovisible(map, id, kClosest)) {
    const Frame& other = map.Find(neighbour.id)->frame;
    const FreeLines theirs(other);
    const LineMatchOptions matching = LineMatchingOf(
        lines, other.cam_from_world.rotation * frame.cam_from_world.rotation.conjugate());
    for (const LineMatch& match : MatchLines(mine.features, theirs.features, matching)) {
      auto& track = tracks[mine.index[static_cast<std::size_t>(match.a)]];
      if (track.empty()) track.push_back({id, mine.index[static_cast<std::size_t>(match.a)]});
      track.push_back({neighbour.id, theirs.index[static_cast<std::size_t>(match.b)]});
    }
  }
  MapEdit edit;
  LineId next = map.NextLineId();
  for (const auto& [feature, views] : tracks) {
    std::optional<MapLine> line;
    const bool all = lines.reconstruction == LineReconstruction::kNView && views.size() > 2;
    if (all) line = Reconstruct(map, imaging.camera, views);
    // Two-view fallback: one wrong match spoils three views, but not those of the right pair.
    for (std::size_t k = 1; !line && k < views.size(); ++k) {
      line = Reconstruct(map, imaging.camera, {views.front(), views[k]});
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
