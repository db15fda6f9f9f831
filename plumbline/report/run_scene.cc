// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_scene.h"

#include "plumbline/report/shown_frames.h"
#include "plumbline/report/summary.h"

#include <cmath>
#include <map>

namespace plumbline {
namespace {

using Eigen::Vector3d;

std::size_t FrameAt(const FrameLog& frames, std::int64_t stamp_ns) {
  // The range of frames in which the first later one is.
  std::size_t first = 0, count = frames.size();
  while (count > 0) {
    const std::size_t half = count / 2;
    const bool earlier = frames.StampOf(first + half) < stamp_ns;
    if (earlier) first += half + 1;
    count = earlier ? count - half - 1 : half;
  }
  return first;
}

void TakePoses(const RunResult& result,
               const Trajectory& trajectory,
               const Similarity3& world_from_map,
               std::vector<std::size_t>& frames,
               std::vector<Rigid3>& poses) {
  for (const StampedPose& pose : trajectory) {
    frames.push_back(FrameAt(result.frames, pose.stamp_ns));
    poses.push_back(TransformPose(world_from_map, pose.world_from_camera));
  }
}

// Returns the pose of a map in the displayed world. A map without comparison to ground truth is
// shown in its own world.
Similarity3 WorldFromMap(const MapScene& scene) {
  return scene.error ? scene.error->reference_from_estimate : Similarity3();
}

MapScene MakeMapScene(const RunResult& result, const Dataset& dataset, const Map& map) {
  MapScene scene;
  scene.id = map.id();
  scene.error = CompareWithGroundTruth(result, dataset, map.id());
  const Similarity3 world_from_map = WorldFromMap(scene);
  TakePoses(result, result.FinalTrajectory(map.id()), world_from_map, scene.frames, scene.poses);
  TakePoses(result,
            result.KeyFrameTrajectory(map.id()),
            world_from_map,
            scene.keyframe_frames,
            scene.keyframe_poses);
  for (const auto& [id, point] : map.points()) {
    scene.points.push_back(world_from_map * point.position);
  }
  for (const MappedLine& line : result.LineMap(map.id())) {
    scene.lines.push_back({world_from_map * line.segment.start, world_from_map * line.segment.end});
  }
  scene.keyframe_count = map.keyframes().size();
  scene.point_count = scene.points.size();
  scene.line_count = scene.lines.size();
  return scene;
}

void Thin(const RunSceneLimits& limits, RunScene& scene) {
  std::size_t points = 0, lines = 0;
  for (const MapScene& map : scene.maps) {
    points += map.point_count;
    lines += map.line_count;
  }
  for (MapScene& map : scene.maps) {
    KeepEvery(StepFor(points, limits.points), map.points);
    KeepEvery(StepFor(lines, limits.lines), map.lines);
  }
  KeepEvery(StepFor(scene.reference.size(), limits.reference), scene.reference);
}

// Returns the ground truth from the first to the last frame of the run.
Trajectory ReferenceDuring(const FrameLog& frames, const Dataset& dataset) {
  Trajectory during;
  if (!dataset.info().ground_truth || frames.empty()) return during;
  for (const StampedPose& pose : dataset.info().ground_truth->OfCamera(dataset.calibration())) {
    if (pose.stamp_ns >= frames.StampOf(0) && pose.stamp_ns <= frames.StampOf(frames.size() - 1)) {
      during.push_back(pose);
    }
  }
  return during;
}

Vector3d UpAxis(const MapScene& map) {
  constexpr double kDecisive = 0.8;
  Vector3d sum = Vector3d::Zero();
  for (const Rigid3& pose : map.poses) sum -= pose.rotation * Vector3d::UnitY();
  int axis = 0;
  const double largest = sum.cwiseAbs().maxCoeff(&axis);
  if (largest <= kDecisive * static_cast<double>(map.poses.size())) {
    return map.error ? Vector3d(0, 0, 1) : Vector3d(0, -1, 0);
  }
  Vector3d up = Vector3d::Zero();
  up(axis) = std::copysign(1.0, sum(axis));
  return up;
}

}  // namespace

RunScene MakeRunScene(const RunResult& result,
                      const Dataset& dataset,
                      const RunSceneLimits& limits) {
  RunScene scene;
  scene.reference = ReferenceDuring(result.frames, dataset);
  if (!scene.reference.empty()) {
    scene.origin = scene.reference.front().world_from_camera.translation;
    scene.up = {0, 0, 1};
  }
  const auto main = result.MainMap();
  std::map<MapId, Similarity3> world_from_map;
  for (const auto& [id, map] : result.atlas.maps()) {
    if (main == id) scene.main = scene.maps.size();
    scene.maps.push_back(MakeMapScene(result, dataset, map));
    world_from_map[id] = WorldFromMap(scene.maps.back());
  }
  scene.events = PlaceEvents(result.events, result.atlas.maps(), world_from_map);
  if (scene.main) {
    const MapScene& map = scene.maps[*scene.main];
    scene.up = UpAxis(map);
    scene.origin = map.poses.front().translation;
  }
  Thin(limits, scene);
  return scene;
}

}  // namespace plumbline
