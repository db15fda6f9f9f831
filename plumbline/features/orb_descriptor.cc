// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/orb_descriptor.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/features/orb_pattern.h"
#include "plumbline/image/opencv_bridge.h"

#include <cstddef>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

// OpenCV smooths a whole image of 8 bits in fixed point, bits as specified; a part of a larger one,
// which is what cv::ORB passes, in floating point.
GrayImage Smoothed(const GrayImage& image) {
  GrayImage result(image.width(), image.height());
  cv::Mat target = AsMat(result);
  cv::GaussianBlur(AsMat(image), target, {7, 7}, 2, 2, cv::BORDER_REFLECT_101);
  return result;
}

// The nearest whole number of a value above -kOrbReach - 1; halves are rounded up.
int Rounded(float value) { return static_cast<int>(value + (kOrbReach + 1.5F)) - (kOrbReach + 1); }

Descriptor Describe(const GrayImage& smooth, const OrientedPixel& corner) {
  const auto cosine = static_cast<float>(math::Cos(corner.angle));
  const auto sine = static_cast<float>(math::Sin(corner.angle));
  const std::ptrdiff_t width = smooth.width();
  const std::uint8_t* centre = smooth.row(corner.y) + corner.x;
  const std::int8_t* place = kOrbPattern.data();
  const auto next_level = [&] {
    const float x = *place++;
    const float y = *place++;
    return centre[Rounded(x * sine + y * cosine) * width + Rounded(x * cosine - y * sine)];
  };
  Descriptor descriptor{};
  for (std::uint64_t& word : descriptor) {
    for (unsigned bit = 0; bit < 64; ++bit) {
      const std::uint8_t first = next_level();
      const std::uint8_t second = next_level();
      word |= std::uint64_t{first < second} << bit;
    }
  }
  return descriptor;
}

}  // namespace

std::vector<Descriptor> DescribeOrb(const GrayImage& image,
                                    const std::vector<OrientedPixel>& corners) {
  std::vector<Descriptor> descriptors;
  if (corners.empty()) return descriptors;
  const GrayImage smooth = Smoothed(image);
  descriptors.reserve(corners.size());
  for (const OrientedPixel& corner : corners) {
    PLUMBLINE_CHECK(corner.x >= kOrbReach && corner.y >= kOrbReach &&
                        corner.x + kOrbReach < image.width() &&
                        corner.y + kOrbReach < image.height(),
                    "a corner to describe, away from the border");
    descriptors.push_back(Describe(smooth, corner));
  }
  return descriptors;
}

}  // namespace plumbline
