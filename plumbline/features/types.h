// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/count_bits.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A 256-bit binary descriptor: ORB for points, LBD for lines.
using Descriptor = std::array<std::uint64_t, 4>;

// Returns the number of differing bits of two descriptors, 0 to 256.
inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  return CountBits(Descriptor{a[0] ^ b[0], a[1] ^ b[1], a[2] ^ b[2], a[3] ^ b[3]});
}

// A corner in the rectified image. Its position is in pixels of the full-size image for every
// octave.
struct PointFeature {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double sigma_px = 1;  // standard deviation of each coordinate (grows with the octave)
  double angle = 0;     // orientation, radians
  double response = 0;
  int octave = 0;
  Descriptor descriptor{};
};

// A straight edge in the rectified image, directed so that the brighter side is on its left in the
// displayed image: above an edge that runs to the right, to the right of one that runs down. A
// physical edge keeps this direction from image to image.
struct LineFeature {
  Segment2 segment;
  double sigma_px = 1;  // standard deviation of each end point across the line
  double response = 0;  // mean gradient across the line, grey levels per pixel
  int octave = 0;
  Descriptor descriptor{};
};

// A line in the right image (real, or virtual from a depth image), directed like its left line.
struct RightLine {
  Segment2 segment;
  double sigma_px = 1;  // standard deviation of each end point across the line
};

// All measurements of one rectified frame. The vectors of one kind have equal length.
struct Features {
  std::vector<PointFeature> points;
  std::vector<std::optional<Disparity>> point_disparity;
  std::vector<LineFeature> lines;
  std::vector<std::optional<RightLine>> line_right;
};

}  // namespace plumbline
