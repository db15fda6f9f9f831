// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/map.h"

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

// Looks for the landmarks of keyframe `from` in keyframe `to`: a feature without landmark becomes a
// new observation; where it has another landmark already, the two are one and are merged (the one
// with more observations stays). Only where the landmark's reprojection agrees with the feature.
MapEdit FuseLandmarks(const Map& map,
                      const ImagingModel& imaging,
                      KeyFrameId from,
                      KeyFrameId to,
                      const FusionOptions& options);

}  // namespace plumbline
