// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/base/parallel.h"
#include "plumbline/features/types.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/image/image.h"
#include "plumbline/image/pyramid.h"

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

namespace plumbline {

struct PointMatchOptions {
  int max_distance = 64;  // largest Hamming distance, of 256 bits
  // Limit for the ratio of the best to the second best distance; 1: no test.
  double ratio = 0.8;
  // Half width of the search window around the same position; 0: no window.
  double radius_px = 0;
  int max_octave_step = 8;   // largest difference of octaves
  double max_angle_deg = 0;  // largest difference of orientations; 0: no test
};

// Returns pairs of points with similar descriptors in two images, each the best match of the other.
// Ties go to the lower index; the result is ordered by `a`. Cost: O(|a| |b|) without a window.
std::vector<FeatureMatch> MatchPoints(const std::vector<PointFeature>& a,
                                      const std::vector<PointFeature>& b,
                                      const PointMatchOptions& options);

struct StereoPointOptions {
  double min_depth_m = 0.25;  // least depth, which determines the largest disparity
  // Half width of the correlation window at the finest level, 2 to 15. No option: smaller windows
  // are less certain, larger ones reach over depth edges more often.
  int window_px = 5;
  // Standard deviation of every disparity due to the pair's calibration, relative to the width of
  // the image: errors of angles and of the lens are the same fraction of an image of any size (8e-4
  // is 1 px of 1250).
  double calibration_sigma = 8e-4;
};

// The pyramids of a rectified pair, with levels of the same sizes, and the valid region of the
// right image.
struct StereoPyramids {
  const ImagePyramid& left;
  const ImagePyramid& right;
  const ValidRegion& right_valid;
};

// Returns the disparity of each point of the left image of a rectified pair; nullopt without a
// reliable match in the right image.
//
// The point is searched along the whole row of the right image, on its pyramid level (RowSearch).
// It need not be a corner in both images; only every second one is. A Gauss-Newton step finds the
// sub-pixel shift, with the mean brightness of the window free. Against errors at depth edges,
// pixels of the window weigh less the further they are from the corner, and windows of coarse
// levels are smaller. sigma_px comes from the curvature and the residual of that correlation.
// Matches whose residual is far above the median are dropped. Disparities are 0 < d <= fx *
// baseline / min_depth. A helper shares the levels; the result is the same with and without it.
std::vector<std::optional<Disparity>> MatchStereoPoints(const RectifiedCamera& camera,
                                                        const std::vector<PointFeature>& points,
                                                        const StereoPyramids& pyramids,
                                                        const StereoPointOptions& options,
                                                        HelperThread* helper = nullptr);

template <class Visitor>
void VisitFields(Visitor&& visit, StereoPointOptions& o) {
  visit("min_depth_m", o.min_depth_m, "nearest depth searched [m]", Range{0.01, 100});
  visit("calibration_sigma",
        o.calibration_sigma,
        "deviation that the calibration of the pair adds to every disparity, relative to the width "
        "of the image",
        Range{0, 0.01});
}
// Returns the options of 0.2.0 that are constants now, with their values.
inline std::vector<RemovedOption> RemovedOptions(std::type_identity<StereoPointOptions>) {
  return {FixedAt("window_px", StereoPointOptions{}.window_px, "StereoPointOptions::window_px")};
}

}  // namespace plumbline
