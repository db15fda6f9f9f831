// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/map.h"

#include <optional>
#include <unordered_map>
#include <vector>

namespace plumbline {

// Looks for landmarks of other keyframes in keyframe `to`: a feature without landmark becomes a new
// observation; where it has another landmark already, the two are one and are merged (the one with
// more observations stays). Only where the landmark's reprojection agrees with the feature.
//
// Which feature looks like a landmark is remembered for the next keyframe that shows it, since
// neighbours show the same: the keyframe may not move meanwhile, nor landmarks move or get other
// looks; they may be merged. The map must outlive it.
class FusionInto {
 public:
  FusionInto(const Map& map, const ImagingModel& imaging, KeyFrameId to);

  // With the landmarks of keyframe `from` as the map is now. O(landmarks that are not remembered,
  // each with the features around its place or all lines).
  MapEdit Fuse(KeyFrameId from);

 private:
  using Choices = std::vector<std::optional<FeatureChoice>>;

  void FusePoints(const Frame& source, MapEdit& edit);
  void FuseLines(const Frame& source, MapEdit& edit);
  std::optional<FeatureChoice> Choose(const MapPoint& point);
  std::optional<FeatureChoice> Choose(const MapLine& line);

  const Map& map_;
  ImagingModel imaging_;
  KeyFrameId to_;
  const Frame* target_;  // of to_, as the map has it during a call
  PointChooser point_chooser_;
  LineChooser line_chooser_;
  const std::vector<bool> no_point_, no_line_;  // that is taken
  std::unordered_map<PointId, std::optional<FeatureChoice>> chosen_by_point_;
  std::unordered_map<LineId, std::optional<FeatureChoice>> chosen_by_line_;
};

}  // namespace plumbline
