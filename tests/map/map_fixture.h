// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <memory>
#include <vector>

namespace plumbline {

constexpr std::size_t kFeatures = 40;  // of each kind in a keyframe of the tests

// Features without content but with descriptors that differ.
inline std::shared_ptr<const FrameFeatures> BlankFeatures() {
  FrameFeatures indexed;
  indexed.features.points.resize(kFeatures);
  indexed.features.point_disparity.resize(kFeatures);
  indexed.features.lines.resize(kFeatures);
  indexed.features.line_right.resize(kFeatures);
  return std::make_shared<const FrameFeatures>(std::move(indexed));
}

inline KeyFrame BlankKeyFrame(std::int64_t id, std::int64_t parent) {
  KeyFrame keyframe;
  keyframe.id = KeyFrameId{id};
  keyframe.parent = KeyFrameId{parent};
  keyframe.frame.id = FrameId{10 * id};
  keyframe.frame.indexed = BlankFeatures();
  keyframe.frame.points.resize(kFeatures);
  keyframe.frame.lines.resize(kFeatures);
  keyframe.frame.cam_from_world.translation = {static_cast<double>(id), 0, 0};
  return keyframe;
}

// Keyframes 0 to count - 1, each the child of the one before.
inline Map ChainOfKeyFrames(std::int64_t count) {
  Map map;
  for (std::int64_t id = 0; id < count; ++id) {
    map.Apply({edit::AddKeyFrame{BlankKeyFrame(id, id - 1)}});
  }
  return map;
}

inline MapPoint PointSeenBy(std::int64_t id, const Observations& observations) {
  MapPoint point;
  point.id = PointId{id};
  point.observations = observations;
  point.position = {0, 0, 5};
  return point;
}

inline MapLine LineSeenBy(std::int64_t id, const Observations& observations) {
  MapLine line;
  line.id = LineId{id};
  line.observations = observations;
  return line;
}

// Observations of keyframes first to last, all by the same feature.
inline Observations SeenBy(std::int64_t first, std::int64_t last, int feature) {
  Observations observations;
  for (std::int64_t k = first; k <= last; ++k) observations.emplace(KeyFrameId{k}, feature);
  return observations;
}

}  // namespace plumbline
