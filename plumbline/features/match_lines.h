// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/types.h"

#include <optional>
#include <vector>

namespace plumbline {

// Conditions on two lines to be matched.
struct LineMatchOptions {
  int max_distance = 80;  // largest Hamming distance, of 256 bits
  // Limit for the ratio of the best to the second best distance; 1: no test.
  double ratio = 0.9;
  bool mutual = true;  // true: a must also be the best match of b
  // Largest difference of the directions (lines are directed: up to 180).
  double max_angle_deg = 20;
  // Largest distance of the midpoint of one line from the other line.
  double max_offset_px = 80;
  // Largest distance of the midpoints minus half of both lengths; 0: no test.
  double max_shift_px = 120;
  // Least length of the shorter line / length of the longer line.
  double min_length_ratio = 0.3;
};

// Returns true if a and b may be the same line, by their positions in two images from nearby
// viewpoints.
bool LinesCompatible(const Segment2& a, const Segment2& b, const LineMatchOptions& options);

// Returns pairs of lines with similar descriptors and compatible positions in two images, at most
// one pair for each line. Ties go to the lower index; the result is ordered by `a`. Cost: O(|a|
// |b|).
std::vector<FeatureMatch> MatchLines(const std::vector<LineFeature>& a,
                                     const std::vector<LineFeature>& b,
                                     const LineMatchOptions& options);

// Conditions on two lines of a rectified pair to be matched.
struct StereoLineOptions {
  // Standard deviation of every disparity due to the calibration, relative to the width of the
  // image.
  double calibration_sigma = 8e-4;
  double min_depth_m = 0.25;  // least depth, which gives the largest disparity
};

// Lines flatter than this against the rows are matched by their position across the rows: the point
// where a row meets them is not certain, and a disparity would not be either.
inline constexpr double kFlatAngleDeg = 5;

// Returns for each left line of a rectified pair its match in the right image, or nullopt.
//
// Both lines have the same direction (bright side) and overlap in rows, and the disparities at both
// ends of the common rows lie in [0, fx * baseline / min_depth_m]. The nearest descriptor wins, in
// both directions. A line flatter than kFlatAngleDeg is matched by its position across the rows
// alone: its MeasuredSegment constrains the line's plane, but LineEndDisparities gives nullopt for
// it.
std::vector<std::optional<MeasuredSegment>> MatchStereoLines(const RectifiedCamera& camera,
                                                             const std::vector<LineFeature>& left,
                                                             const std::vector<LineFeature>& right,
                                                             const StereoLineOptions& options);

// The disparities of the two end points of a left line.
struct LineEndDisparity {
  Disparity start, end;
};

// Returns the disparities of the end points of a left line: the intersections of their rows with
// the (infinite) right line. sigma_px is the noise of both lines across themselves, divided by the
// sine of the angle between line and row. Returns nullopt if that angle is below `flat_angle_deg`
// or a disparity is not positive.
std::optional<LineEndDisparity> LineEndDisparities(const LineFeature& left,
                                                   const MeasuredSegment& right,
                                                   double flat_angle_deg = kFlatAngleDeg);

template <class Visitor>
void VisitFields(Visitor&& visit, StereoLineOptions& o) {
  visit("calibration_sigma",
        o.calibration_sigma,
        "deviation that the calibration of the pair adds to every disparity, relative to the width "
        "of the image",
        Range{0, 0.01});
  visit("min_depth_m", o.min_depth_m, "nearest depth searched [m]", Range{0.01, 100});
}
// Returns the options of 0.2.0 that are constants now, with their values.
std::vector<RemovedOption> RemovedOptions(std::type_identity<StereoLineOptions>);

}  // namespace plumbline
