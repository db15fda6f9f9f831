// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/measurements.h"

#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numbers>
#include <variant>
#include <vector>

namespace plumbline::testing {

// A camera that looks outwards from a circle of 4 m, and goes round it more than once, in a world
// of landmarks all around. The map has a landmark anew in each round, as odometry makes it, and
// drifts.
struct LoopSceneOptions {
  int keyframes_per_round = 40;
  int keyframes = 46;
  std::size_t points = 900;
  std::size_t lines = 150;
  int alike_sectors = 1;  // so many parts of the circle look exactly the same
  int poster_points = 0;  // of a thing before keyframe 3 that is also before keyframe 20
  SensorModel sensor;
  // Of the world around a keyframe, against the truth.
  std::function<Similarity3(int)> drift = [](int) { return Similarity3{}; };
};

struct LoopScene {
  SyntheticWorld world;
  std::vector<Rigid3> truth;  // cam_from_world by keyframe
  Map map;

  CameraAndPyramid Imaging() const { return world.Imaging(); }
  KeyFrameId Newest() const { return map.keyframes().rbegin()->first; }
};

namespace loop_scene_detail {

inline Eigen::Vector3d OnCircle(double angle, double radius, double height) {
  return {radius * std::sin(angle), height, radius * std::cos(angle)};
}

inline Rigid3 PoseOnCircle(double angle) {
  const Eigen::Quaterniond world_from_cam = ExpSo3(Eigen::Vector3d(0, angle, 0));
  return Inverse(Rigid3{world_from_cam, OnCircle(angle, 4, 0)});
}

inline SyntheticWorld MakeWorld(const LoopSceneOptions& options) {
  Rng rng(11, "loop_scene");
  SyntheticWorld world;
  if (!options.sensor.depth) world.camera.baseline = 0;
  const double sector = 2 * std::numbers::pi / options.alike_sectors;
  const auto copies = static_cast<std::size_t>(options.alike_sectors);
  for (std::size_t i = 0; i < options.points / copies; ++i) {
    const double angle = rng.Uniform(0, sector);
    const Eigen::Vector3d place = OnCircle(angle, rng.Uniform(7, 11), rng.Uniform(-2.5, 2.5));
    const Descriptor descriptor = RandomDescriptor(rng);
    for (int k = 0; k < options.alike_sectors; ++k) {
      world.points.push_back({ExpSo3(Eigen::Vector3d(0, k * sector, 0)) * place, descriptor});
    }
  }
  const double step = 2 * std::numbers::pi / options.keyframes_per_round;
  for (int i = 0; i < options.poster_points; ++i) {
    const double angle = rng.Uniform(-0.06, 0.06);
    const double height = rng.Uniform(-0.5, 0.5);
    const Descriptor descriptor = RandomDescriptor(rng);
    for (const int keyframe : {3, 20}) {
      world.points.push_back({OnCircle(angle + step * keyframe, 9, height), descriptor});
    }
  }
  for (std::size_t i = 0; i < options.lines / copies; ++i) {
    const double angle = rng.Uniform(0, sector);
    const Eigen::Vector3d start = OnCircle(angle, rng.Uniform(7, 11), rng.Uniform(-2.5, 2.5));
    const Eigen::Vector3d end = start + rng.Uniform(0.6, 2) * RandomVector<3>(rng).normalized();
    const Descriptor descriptor = RandomDescriptor(rng);
    for (int k = 0; k < options.alike_sectors; ++k) {
      const Eigen::Quaterniond turn = ExpSo3(Eigen::Vector3d(0, k * sector, 0));
      world.lines.push_back({{turn * start, turn * end}, descriptor});
    }
  }
  return world;
}

// What the keyframes show of each landmark of the world, by stretches of keyframes without a gap.
inline std::vector<std::pair<std::size_t, Observations>> Stretches(
    const std::vector<SyntheticFrame>& sensed, std::vector<std::size_t> SyntheticFrame::*truth) {
  constexpr std::int64_t kGap = 10;
  std::vector<std::pair<std::size_t, Observations>> stretches;
  std::map<std::size_t, std::size_t> last;  // by landmark, its last stretch
  for (std::size_t k = 0; k < sensed.size(); ++k) {
    const KeyFrameId id{static_cast<std::int64_t>(k)};
    const std::vector<std::size_t>& indices = sensed[k].*truth;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const auto known = last.find(indices[i]);
      if (known == last.end() ||
          stretches[known->second].second.newest().first.value + kGap < id.value) {
        last[indices[i]] = stretches.size();
        stretches.emplace_back(indices[i], Observations{});
      }
      stretches[last[indices[i]]].second.emplace(id, static_cast<int>(i));
    }
  }
  return stretches;
}

inline MapEdit Landmarks(const LoopScene& scene, const std::vector<SyntheticFrame>& sensed) {
  MapEdit edit;
  std::int64_t next_point = 0;
  for (const auto& [index, seen] : Stretches(sensed, &SyntheticFrame::point_truth)) {
    MapPoint point;
    point.id = PointId{next_point++};
    point.position = scene.world.points[index].position;
    point.created_by = seen.begin()->first;
    point.observations = seen;
    edit.push_back(edit::AddPoint{point});
    edit.push_back(edit::RefreshPoint{point.id});
  }
  std::int64_t next_line = 0;
  for (const auto& [index, seen] : Stretches(sensed, &SyntheticFrame::line_truth)) {
    MapLine line;
    line.id = LineId{next_line++};
    const Segment3& segment = scene.world.lines[index].segment;
    line.line = LineThroughPoints(segment.start, segment.end);
    line.start = line.line.ParameterOf(segment.start);
    line.end = line.line.ParameterOf(segment.end);
    line.created_by = seen.begin()->first;
    line.observations = seen;
    for (const auto& [keyframe, feature] : seen) {
      line.information += LineInformation(scene.world.camera,
                                          scene.map.Find(keyframe)->frame,
                                          static_cast<std::size_t>(feature),
                                          line.line);
    }
    edit.push_back(edit::AddLine{line});
    edit.push_back(edit::RefreshLine{line.id});
  }
  return edit;
}

}  // namespace loop_scene_detail

inline LoopScene MakeLoopScene(const LoopSceneOptions& options) {
  LoopScene scene;
  scene.world = loop_scene_detail::MakeWorld(options);
  std::vector<SyntheticFrame> sensed;
  Rng rng(5, "loop_scene_frames");
  edit::MoveKeyFrames drift;
  for (int k = 0; k < options.keyframes; ++k) {
    const double angle = 2 * std::numbers::pi * k / options.keyframes_per_round;
    scene.truth.push_back(loop_scene_detail::PoseOnCircle(angle));
    sensed.push_back(Sense(scene.world, scene.truth.back(), options.sensor, rng));
    const KeyFrameId id{k};
    scene.map.Apply({edit::AddKeyFrame{
        {id, KeyFrameId{k - 1}, MakeFrame(FrameId{k}, scene.truth.back(), sensed.back())}}});
    drift.new_from_old[id] = options.drift(k);
  }
  scene.map.Apply(loop_scene_detail::Landmarks(scene, sensed));
  scene.map.Apply({drift});
  return scene;
}

// The largest distance of a keyframe from its true place.
inline double WorstPlace(const LoopScene& scene) {
  double worst = 0;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    worst = std::max(worst,
                     CentreDistance(keyframe.frame.cam_from_world,
                                    scene.truth[static_cast<std::size_t>(id.value)]));
  }
  return worst;
}

// The largest distance between the places of a keyframe in two maps that have the same keyframes.
inline double LargestShift(const Map& a, const Map& b) {
  double largest = 0;
  for (const auto& [id, keyframe] : a.keyframes()) {
    largest = std::max(largest, CentreDistance(keyframe.frame.cam_from_world, b.PoseOf(id)));
  }
  return largest;
}

// The number of changes of a kind in an edit.
template <class Change>
int CountOf(const MapEdit& edit) {
  return static_cast<int>(std::count_if(edit.begin(), edit.end(), [](const MapChange& change) {
    return std::holds_alternative<Change>(change);
  }));
}

// Drift by a turn and a climb that grow with the keyframes.
inline Similarity3 GrowingDrift(int keyframe) {
  Vector7d tangent = Vector7d::Zero();
  tangent << 0, 0.001 * keyframe, 0.0003 * keyframe, 0, 0.004 * keyframe, 0, 0;
  return ExpSim3(tangent);
}

// The same with a scale that shrinks to nine tenths over 40 keyframes.
inline Similarity3 ShrinkingDrift(int keyframe) {
  Similarity3 drift = GrowingDrift(keyframe);
  drift.scale = std::pow(0.9, keyframe / 40.0);
  return drift;
}

}  // namespace plumbline::testing
