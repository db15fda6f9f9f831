// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/orb_descriptor.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"
#include "plumbline/features/orb_pattern.h"
#include "plumbline/image/gaussian_blur.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace plumbline {
namespace {

constexpr std::size_t kPlaces = kOrbPattern.size() / 2;

// The places that are compared, x and y in separate arrays, so that vector instructions turn
// several at once.
struct PatternAxes {
  std::array<float, kPlaces> x;
  std::array<float, kPlaces> y;
};

constexpr PatternAxes AxesOfPattern() {
  PatternAxes axes{};
  for (std::size_t i = 0; i < kPlaces; ++i) {
    axes.x[i] = static_cast<float>(kOrbPattern[2 * i]);
    axes.y[i] = static_cast<float>(kOrbPattern[2 * i + 1]);
  }
  return axes;
}

constexpr PatternAxes kAxes = AxesOfPattern();

// Computes the offsets of the rotated samples in the memory of an image of this width, relative to
// the corner.
struct TurnPattern {
  [[gnu::always_inline]] static inline void Run(float cosine,
                                                float sine,
                                                float width,
                                                std::array<std::int32_t, kPlaces>& offsets) {
    // This rounds a value above -kOrbReach - 1 to the nearest whole number; halves are rounded up.
    constexpr float kShift = kOrbReach + 1.5F;
    constexpr int kWholeShift = kOrbReach + 1;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const float x = kAxes.x[i];
      const float y = kAxes.y[i];
      const int row = static_cast<int>(x * sine + y * cosine + kShift) - kWholeShift;
      const int column = static_cast<int>(x * cosine - y * sine + kShift) - kWholeShift;
      // The product is exact as a float, and every processor has vector instructions for products
      // of floats.
      offsets[i] = static_cast<int>(static_cast<float>(row) * width) + column;
    }
  }
};

Descriptor Describe(const GrayImage& smooth, const OrientedPixel& corner) {
  std::array<std::int32_t, kPlaces> offsets;
  RunBest<TurnPattern>(static_cast<float>(math::Cos(corner.angle)),
                       static_cast<float>(math::Sin(corner.angle)),
                       static_cast<float>(smooth.width()),
                       offsets);
  const std::uint8_t* centre = smooth.row(corner.y) + corner.x;
  const std::int32_t* place = offsets.data();
  Descriptor descriptor{};
  for (std::uint64_t& word : descriptor) {
    for (unsigned bit = 0; bit < 64; ++bit, place += 2) {
      word |= std::uint64_t{centre[place[0]] < centre[place[1]]} << bit;
    }
  }
  return descriptor;
}

}  // namespace

std::vector<Descriptor> DescribeOrb(const GrayImage& image,
                                    const std::vector<OrientedPixel>& corners) {
  std::vector<Descriptor> descriptors;
  if (corners.empty()) return descriptors;
  const GrayImage smooth = Blurred(image, kBlurSigma2, ImageBorder::kReflected);
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
