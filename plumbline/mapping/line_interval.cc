// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/line_interval.h"

#include "plumbline/geometry/trimming.h"
#include "plumbline/matching/line_information.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr std::size_t kViewsForTrimming = 4;

}  // namespace

edit::MoveLine RefitInterval(const Map& map,
                             const CameraAndPyramid& imaging,
                             const std::map<KeyFrameId, Rigid3>& poses,
                             const MapLine& line,
                             const PluckerLine& moved,
                             const std::optional<Segment3>& kept) {
  PluckerLine target = moved;
  if (target.direction.dot(line.line.direction) < 0) target = {-moved.moment, -moved.direction};
  edit::MoveLine change{line.id, target, 0, 0, Eigen::Matrix4d::Zero()};
  const PreparedLine prepared(ToOrthonormal(target));
  std::vector<double> starts;
  std::vector<double> ends;
  for (const auto& [id, feature] : line.observations) {
    const Frame& in_map = map.Find(id)->frame;
    const auto it = poses.find(id);
    Frame frame;  // has the features, which are shared, and the new pose; matches are not needed
    frame.indexed = in_map.indexed;
    frame.cam_from_world = it != poses.end() ? it->second : in_map.cam_from_world;
    const auto i = static_cast<std::size_t>(feature);
    change.information += LineInformation(imaging.camera, frame, i, prepared);
    if (kept) continue;
    const auto interval = TrimToSegment(
        imaging.camera, frame.cam_from_world, target, frame.features().lines[i].segment);
    if (!interval) continue;
    starts.push_back(std::min(interval->start, interval->end));
    ends.push_back(std::max(interval->start, interval->end));
  }
  if (starts.empty()) {
    const Segment3 points = kept.value_or(line.Interval());
    change.start = target.ParameterOf(points.start);
    change.end = target.ParameterOf(points.end);
    if (kept && change.end < change.start) std::swap(change.start, change.end);
    return change;
  }
  std::sort(starts.begin(), starts.end());
  std::sort(ends.begin(), ends.end());
  const std::size_t skip = starts.size() >= kViewsForTrimming ? 1 : 0;
  change.start = starts[skip];
  change.end = ends[ends.size() - 1 - skip];
  if (change.end <= change.start) {
    change.start = starts.front();
    change.end = ends.back();
  }
  return change;
}

}  // namespace plumbline
