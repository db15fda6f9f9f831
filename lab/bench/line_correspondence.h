// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/image/image.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline::bench {

// Expected position of a line of one image in another one, and the detected lines that match it.
struct ExpectedLine {
  std::optional<Segment2> place;  // nullopt: unknown or not in view
  std::vector<int> same;          // lines of the other image that match
  bool unclear = false;           // true if a line lies there, but too little of it to decide
};

struct SameLineLimits {
  double distance_px = 2;  // across, at both ends of the common part
  double angle_deg = 2;
  double overlap = 0.5;
};

// Distances of `found` across `expected` at both ends of their common part; nullopt if they do not
// overlap, or run in opposite directions.
std::optional<std::array<double, 2>> AcrossDistances(const Segment2& expected,
                                                     const Segment2& found);

// Sets `same` and `unclear` from the detected lines.
void FindSame(const std::vector<LineFeature>& found,
              const SameLineLimits& limits,
              std::vector<ExpectedLine>* lines);

// A plane motion of the image plane.
struct KnownWarp {
  std::string name;
  Eigen::Matrix3d warped_from_image;
};

// A rotation, a smaller and a larger scale, a subpixel shift and two perspective views.
std::vector<KnownWarp> KnownWarps(int width, int height);

// A warped image: pixels by bicubic interpolation plus white noise of two grey levels, so that the
// noise is not repeated. 255 in `mask` for real pixels.
struct WarpedImage {
  GrayImage image;
  GrayImage mask;
};
WarpedImage WarpImage(const GrayImage& image,
                      const GrayImage& mask,
                      const KnownWarp& warp,
                      std::uint64_t seed);

// Returns the lines moved by the warp; those not wholly in view, or shorter than `min_length`, have
// no position.
std::vector<ExpectedLine> WarpLines(const std::vector<LineFeature>& lines,
                                    const KnownWarp& warp,
                                    const ValidRegion& valid,
                                    double min_length);

}  // namespace plumbline::bench
