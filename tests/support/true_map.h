// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/triangulation.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/measurements.h"

#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <map>
#include <vector>

namespace plumbline {

// A map of a synthetic world in which keyframe k has the given pose and observes each visible
// landmark, all of them at their true positions.
struct TrueMap {
  Map map;
  std::vector<SyntheticFrame> sensed;       // by keyframe
  std::map<std::size_t, PointId> point_of;  // by the world's index
  std::map<std::size_t, LineId> line_of;
};

// Appends a keyframe (without matches) to the map, at the pose given.
inline KeyFrameId AddKeyFrameTo(Map& map,
                                const Rigid3& cam_from_world,
                                const SyntheticFrame& sensed) {
  const KeyFrameId id = map.NextKeyFrameId();
  map.Apply({edit::AddKeyFrame{
      {id, KeyFrameId{id.value - 1}, MakeFrame(FrameId{id.value}, cam_from_world, sensed)}}});
  return id;
}

// Largest distance of a keyframe from its true position; `truth` by keyframe, cam_from_world.
inline double WorstPose(const Map& map, const std::vector<Rigid3>& truth) {
  double worst = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const auto k = static_cast<std::size_t>(id.value);
    worst = std::max(worst, CentreDistance(keyframe.frame.cam_from_world, truth[k]));
  }
  return worst;
}

namespace true_map_detail {

// Returns the keyframes that see each landmark of the world.
inline std::map<std::size_t, Observations> Gather(const std::vector<SyntheticFrame>& sensed,
                                                  std::vector<std::size_t> SyntheticFrame::*truth) {
  std::map<std::size_t, Observations> all;
  for (std::size_t k = 0; k < sensed.size(); ++k) {
    const std::vector<std::size_t>& indices = sensed[k].*truth;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      all[indices[i]].emplace(KeyFrameId{static_cast<std::int64_t>(k)}, static_cast<int>(i));
    }
  }
  return all;
}

}  // namespace true_map_detail

inline TrueMap MakeTrueMap(const SyntheticWorld& world,
                           const std::vector<Rigid3>& poses,
                           const SensorModel& sensor,
                           std::uint64_t seed = 1) {
  TrueMap result;
  Rng rng(seed, "true_map");
  for (const Rigid3& pose : poses) {
    result.sensed.push_back(Sense(world, pose, sensor, rng));
    AddKeyFrameTo(result.map, pose, result.sensed.back());
  }
  MapEdit edit;
  for (const auto& [index, seen] :
       true_map_detail::Gather(result.sensed, &SyntheticFrame::point_truth)) {
    MapPoint point;
    point.id = PointId{static_cast<std::int64_t>(result.point_of.size())};
    point.position = world.points[index].position;
    point.created_by = seen.begin()->first;
    point.observations = seen;
    result.point_of[index] = point.id;
    edit.push_back(edit::AddPoint{point});
    edit.push_back(edit::RefreshPoint{point.id});
  }
  for (const auto& [index, seen] :
       true_map_detail::Gather(result.sensed, &SyntheticFrame::line_truth)) {
    MapLine line;
    line.id = LineId{static_cast<std::int64_t>(result.line_of.size())};
    const Segment3& segment = world.lines[index].segment;
    line.line = LineThroughPoints(segment.start, segment.end);
    line.start = line.line.ParameterOf(segment.start);
    line.end = line.line.ParameterOf(segment.end);
    line.created_by = seen.begin()->first;
    line.observations = seen;
    for (const auto& [keyframe, feature] : seen) {
      line.information += LineInformation(world.camera,
                                          result.map.Find(keyframe)->frame,
                                          static_cast<std::size_t>(feature),
                                          line.line);
    }
    result.line_of[index] = line.id;
    edit.push_back(edit::AddLine{line});
    edit.push_back(edit::RefreshLine{line.id});
  }
  result.map.Apply(edit);
  return result;
}

}  // namespace plumbline
