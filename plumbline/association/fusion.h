// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/map.h"

#include <optional>
#include <unordered_map>
#include <vector>

namespace plumbline {

struct FusionOptions {
  double point_radius_px = 3;  // at octave 0
  int point_max_distance = 50;
  double line_offset_px = 4;
  double line_angle_deg = 4;
  int line_max_distance = 60;
  double max_chi2 = 5.99;  // of a landmark's reprojection, per measurement of two residuals
};

template <class Visitor>
void VisitFields(Visitor&& visit, FusionOptions& o) {
  visit("point_radius_px", o.point_radius_px, "search radius of a point [px]", Range{0.5, 50});
  visit("point_max_distance", o.point_max_distance, "largest Hamming distance", Range{0, 256});
  visit("line_offset_px", o.line_offset_px, "search distance across a line [px]", Range{0.5, 50});
  visit("line_angle_deg",
        o.line_angle_deg,
        "largest angle to the projected line [deg]",
        Range{0.1, 45});
  visit("line_max_distance", o.line_max_distance, "largest Hamming distance", Range{0, 256});
  visit("max_chi2", o.max_chi2, "largest reprojection error, squared sigmas", Range{0.1, 100});
}

// Looks for landmarks of other keyframes in keyframe `to`: a feature without landmark becomes a new
// observation; where it has another landmark already, the two are one and are merged (the one with
// more observations stays). Only where the landmark's reprojection agrees with the feature.
//
// Which feature looks like a landmark is remembered for the next keyframe that shows it, since
// neighbours show the same: the keyframe may not move meanwhile, nor landmarks move or get other
// looks; they may be merged. Map and options must outlive it.
class FusionInto {
 public:
  FusionInto(const Map& map,
             const ImagingModel& imaging,
             KeyFrameId to,
             const FusionOptions& options);

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
  const FusionOptions& options_;
  ProjectionSearchOptions search_;
  const Frame& target_;
  PointChooser point_chooser_;
  LineChooser line_chooser_;
  const std::vector<bool> no_point_, no_line_;  // that is taken
  std::unordered_map<PointId, std::optional<FeatureChoice>> chosen_by_point_;
  std::unordered_map<LineId, std::optional<FeatureChoice>> chosen_by_line_;
};

}  // namespace plumbline
