// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/optional_list.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Returns the number of bits set in up to 31 words. Processors that we compile for need not have an
// instruction for it, and std::popcount then uses a table of bytes. Adding neighbouring fields of
// all words at once takes a third of that time.
template <std::size_t kWords>
int CountBits(const std::array<std::uint64_t, kWords>& words) {
  static_assert(kWords <= 31, "sums of bytes must fit into bytes");
  constexpr std::uint64_t kEverySecond = 0x5555555555555555, kPairs = 0x3333333333333333,
                          kNibbles = 0x0f0f0f0f0f0f0f0f, kBytes = 0x00ff00ff00ff00ff,
                          kSumToTheTop = 0x0001000100010001;
  std::uint64_t sums = 0;  // sum of the bits of each byte
  for (std::uint64_t word : words) {
    word -= word >> 1U & kEverySecond;
    word = (word & kPairs) + (word >> 2U & kPairs);
    sums += (word + (word >> 4U)) & kNibbles;
  }
  return static_cast<int>(((sums & kBytes) + (sums >> 8U & kBytes)) * kSumToTheTop >> 48U);
}

// A 256-bit binary descriptor: ORB for points, LBD for lines.
using Descriptor = std::array<std::uint64_t, 4>;

// Returns the number of differing bits of two descriptors, 0 to 256.
inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  return CountBits(Descriptor{a[0] ^ b[0], a[1] ^ b[1], a[2] ^ b[2], a[3] ^ b[3]});
}

// A corner in the rectified image. Its position is in pixels of the full-size image for every
// octave. Keyframes keep a thousand of them each, thus the small types.
struct PointFeature {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double sigma_px = 1;         // standard deviation of each coordinate (grows with the octave)
  float angle = 0;             // orientation, radians
  std::uint16_t response = 0;  // largest threshold at which it is a corner, grey levels
  std::int16_t octave = 0;
  Descriptor descriptor{};
};
static_assert(sizeof(PointFeature) == 64);

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

// A segment measured in an image. As the right line of a LineFeature it is in the right image
// (real, or virtual from a depth image), directed like its left line.
struct MeasuredSegment {
  Segment2 segment;
  double sigma_px = 1;  // standard deviation of each end point across the line
};

// A pair of matched points, or of matched lines, of two sets.
struct FeatureMatch {
  int a = -1;          // index into the first set
  int b = -1;          // index into the second set
  int distance = 256;  // Hamming distance of the descriptors
};

// All measurements of one rectified frame. The lists of one kind have equal length.
struct Features {
  std::vector<PointFeature> points;
  OptionalList<Disparity> point_disparity;
  std::vector<LineFeature> lines;
  OptionalList<MeasuredSegment> line_right;
};

}  // namespace plumbline
