// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/extractor.h"
#include "plumbline/map/saved_atlas.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

namespace plumbline {

inline const RectifiedCamera kMapCamera{450, 451, 375.5, 239.25, 0.11, 752, 480};
inline const Eigen::Quaterniond kMapRotation(0.8, 0.6, 0, 0);

// Three points, the second without disparity, and two lines, the first with a right line.
inline Features ThreePointsAndTwoLines(std::int64_t id) {
  Features f;
  for (int i = 0; i < 3; ++i) {
    PointFeature point;
    point.px = {3.25 + i, 20.5 * static_cast<double>(id)};
    point.angle = -0.125F * static_cast<float>(i);
    point.response = 7;
    point.octave = static_cast<std::int16_t>(i);
    point.descriptor = {1U,
                        static_cast<std::uint64_t>(id),
                        std::numeric_limits<std::uint64_t>::max(),
                        static_cast<std::uint64_t>(i)};
    f.points.push_back(point);
    f.point_disparity.push_back(i == 1 ? std::nullopt : std::optional(Disparity{3.25, 0.5}));
  }
  for (int i = 0; i < 2; ++i) {
    LineFeature line;
    line.segment = {{1, 2}, {30, 4.125}};
    line.descriptor = {static_cast<std::uint64_t>(id), static_cast<std::uint64_t>(i), 5U, 6U};
    f.lines.push_back(line);
    f.line_right.push_back(i == 0 ? std::optional(MeasuredSegment{{{0, 2}, {29, 4}}, 0.75})
                                  : std::nullopt);
  }
  return f;
}

inline KeyFrame MakeKeyFrame(std::int64_t id, std::int64_t parent) {
  KeyFrame keyframe;
  keyframe.id = KeyFrameId{id};
  keyframe.parent = KeyFrameId{parent};
  keyframe.frame.id = FrameId{10 * id};
  keyframe.frame.stamp_ns = 1'403'636'584'763'555'584 + id;
  keyframe.frame.cam_from_world = ExpSe3(Vector6d::Constant(0.1 * static_cast<double>(id)));
  keyframe.frame.indexed = IndexFeatures(kMapCamera, ThreePointsAndTwoLines(id));
  keyframe.frame.points.resize(3);
  keyframe.frame.lines.resize(2);
  return keyframe;
}

inline StereoCorrection SomeCorrection() {
  Vector6d k;
  k << 0.1, -0.2, 0.3, -0.4, 0.5, -0.6;
  return {kMapCamera, k};
}

// Adds to the map, an empty one, keyframes 0, 2, 3 (1 was removed, the parent of 2) and 4 (moved
// and doubled), points 0, 4 and 5 (which became 4), line 1; with a stereo correction.
inline void FillMap(Map& map) {
  const std::int64_t k = map.NextKeyFrameId().value;
  const std::int64_t p = map.NextPointId().value;
  const std::int64_t l = map.NextLineId().value;
  const auto id = [&](std::int64_t i) { return KeyFrameId{k + i}; };
  map.Apply({edit::AddKeyFrame{MakeKeyFrame(k, -1)},
             edit::AddKeyFrame{MakeKeyFrame(k + 1, k)},
             edit::AddKeyFrame{MakeKeyFrame(k + 2, k + 1)},
             edit::AddKeyFrame{MakeKeyFrame(k + 3, k + 2)},
             edit::AddKeyFrame{MakeKeyFrame(k + 4, k + 3)}});
  MapPoint first;
  first.id = PointId{p};
  first.created_by = id(0);
  first.position = {1.0 / 3, -2, 5};
  first.view_direction = Eigen::Vector3d(1, 2, 3).normalized();
  first.reference_distance = 5.1;
  first.reference_octave = 2;
  first.score = {7, 5};
  first.observations = {{id(0), 0}, {id(2), 1}};
  MapPoint second = first;
  second.id = PointId{p + 4};
  second.observations = {{id(0), 2}, {id(1), 2}, {id(3), 0}};
  second.descriptor = {9, 9, 9, 9};
  MapPoint third = first;
  third.id = PointId{p + 5};
  third.observations = {{id(4), 1}};
  MapLine line;
  line.id = LineId{l + 1};
  line.created_by = id(1);
  line.line = LineThroughPoints({0, 0, 2}, {1, 1, 3});
  line.start = -1;
  line.end = 1.5;
  line.information = Eigen::Matrix4d::Constant(0.1) + 0.3 * Eigen::Matrix4d::Identity();
  line.observations = {{id(2), 0}, {id(3), 1}};
  map.Apply({edit::AddPoint{first},
             edit::AddPoint{second},
             edit::AddPoint{third},
             edit::AddLine{line},
             edit::RefreshPoint{first.id},
             edit::RefreshLine{line.id},
             edit::RemoveKeyFrame{id(1)},
             edit::MergePoints{second.id, third.id},
             edit::MoveKeyFrames{{{id(4), Similarity3{2}}}},
             edit::CorrectFeatures{{SomeCorrection()}}});
}

// Two maps, the first one active, and a context in which nothing is as by default.
inline SavedAtlas MakeSavedAtlas() {
  SavedAtlas saved;
  FillMap(saved.atlas.Start());
  Map& second = saved.atlas.Start();
  second.Apply({edit::AddKeyFrame{MakeKeyFrame(saved.atlas.NextKeyFrameId().value, -1)}});
  saved.atlas.Activate(MapId{0});
  AtlasContext& c = saved.context;
  c.camera = kMapCamera;
  c.rectified_from_left = kMapRotation;
  c.octave_scale = 1.3;
  c.stereo_evidence.information = Matrix6d::Identity() / 3;
  c.stereo_evidence.weighted = Vector6d::Constant(0.1);
  c.stereo_evidence.moments = Matrix6d::Constant(7);
  c.feature_format = kFeatureFormat;
  c.options_yaml = "slam:\n  seed: 3\n";
  c.sessions = {{UuidOf("one"), "0.1", "MH_01", 5, 7}};
  c.maps[MapId{0}] = {UuidOf("map 0"), {{PointId{0}, PointId{99}}, {LineId{1}}}};
  c.maps[MapId{1}] = {UuidOf("map 1"), {}};
  return saved;
}

}  // namespace plumbline
