// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <optional>
#include <unordered_map>
#include <vector>

namespace plumbline {

// Searches keyframe `to` for landmarks of other keyframes. A feature without landmark becomes a new
// observation. If the feature already shows another landmark, the two are merged; the one with more
// observations stays. Both require that the landmark's reprojection agrees with the feature.
//
// The matched feature of a landmark is cached for the next keyframe that shows the landmark, since
// neighbours share landmarks. Meanwhile the keyframe must not move, nor landmarks move or change
// their descriptors; they may be merged. The map must outlive this object.
class FusionInto {
 public:
  FusionInto(const Map& map, const CameraAndPyramid& imaging, KeyFrameId to);

  // Fuses with the landmarks that keyframe `from` shows in the current map. O(landmarks not cached,
  // each with the features around its projection or all lines).
  MapEdit Fuse(KeyFrameId from);

 private:
  using Choices = std::vector<std::optional<ProjectionMatch>>;

  void FusePoints(const Frame& source, MapEdit& edit);
  void FuseLines(const Frame& source, MapEdit& edit);
  std::optional<ProjectionMatch> Choose(const MapPoint& point);
  std::optional<ProjectionMatch> Choose(const MapLine& line);

  const Map& map_;
  CameraAndPyramid imaging_;
  KeyFrameId to_;
  const Frame* target_;  // features of to_ in the map, valid during a call
  PointProjectionMatcher point_matcher_;
  LineProjectionMatcher line_matcher_;
  const std::vector<bool> no_point_, no_line_;  // all false: no feature counts as taken
  std::unordered_map<PointId, std::optional<ProjectionMatch>> chosen_by_point_;
  std::unordered_map<LineId, std::optional<ProjectionMatch>> chosen_by_line_;
};

}  // namespace plumbline
