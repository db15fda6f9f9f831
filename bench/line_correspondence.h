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

// Where the lines of one image ought to be in another one, and which lines found there they are.
struct ExpectedLine {
  std::optional<Segment2> place;  // nullopt: not known or not in view
  std::vector<int> same;          // lines of the other image that are this line
  bool unclear = false;           // a line lies there, but too little of it to say
};

struct SameLineLimits {
  double distance_px = 2;  // across, at both ends of the common part
  double angle_deg = 2;
  double overlap = 0.5;
};

// Distances of `found` across `expected` at both ends of their common part; nullopt when they do
// not overlap, or run in opposite directions.
std::optional<std::array<double, 2>> AcrossDistances(const Segment2& expected,
                                                     const Segment2& found);

// Fills in `same` and `unclear` from the lines found.
void FindSame(const std::vector<LineFeature>& found,
              const SameLineLimits& limits,
              std::vector<ExpectedLine>* lines);

// A plane motion of the image plane.
struct KnownWarp {
  std::string name;
  Eigen::Matrix3d warped_from_image;
};

// A turn, a smaller and a larger scale, a shift by parts of a pixel and two perspective views.
std::vector<KnownWarp> KnownWarps(int width, int height);

// What a warp makes of an image: pixels by bicubic interpolation plus white noise of two grey
// levels, so that it is not the noise that repeats. 255 in `mask` where all is real.
struct WarpedImage {
  GrayImage image;
  GrayImage mask;
};
WarpedImage WarpImage(const GrayImage& image,
                      const GrayImage& mask,
                      const KnownWarp& warp,
                      std::uint64_t seed);

// The lines as the warp moves them; those that do not come to lie wholly in view, or become shorter
// than `min_length`, have no place.
std::vector<ExpectedLine> WarpLines(const std::vector<LineFeature>& lines,
                                    const KnownWarp& warp,
                                    const ValidRegion& valid,
                                    double min_length);

}  // namespace plumbline::bench
