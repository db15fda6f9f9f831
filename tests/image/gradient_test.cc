// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/gradient.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

GrayImage Ramp() {
  GrayImage image(40, 30);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) image.at(x, y) = static_cast<std::uint8_t>(3 * x + 2 * y);
  }
  return image;
}

TEST(Gradient, IsTheSlopeOfARampInGreyLevelsPerPixel) {
  for (const double sigma : {0.0, 1.0}) {
    const GradientImage gradient = ComputeGradient(Ramp(), sigma);
    EXPECT_LT((GradientAt(gradient, {17.3, 12.8}) - Eigen::Vector2d(3, 2)).norm(), 0.1);
  }
}

TEST(Gradient, IsZeroOutsideTheImage) {
  const GradientImage gradient = ComputeGradient(Ramp());
  EXPECT_EQ(GradientAt(gradient, {-0.1, 5}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(GradientAt(gradient, {5, 29.1}), Eigen::Vector2d(0, 0));
  EXPECT_NE(GradientAt(gradient, {20, 29}), Eigen::Vector2d(0, 0));  // the last row is inside
}

TEST(Intensity, IsInterpolatedAndClampedToTheImage) {
  const GrayImage ramp = Ramp();
  EXPECT_NEAR(IntensityAt(ramp, {10.5, 4.25}), 3 * 10.5 + 2 * 4.25, 1e-9);
  EXPECT_NEAR(IntensityAt(ramp, {-9, -9}), 0, 1e-9);
  EXPECT_NEAR(IntensityAt(ramp, {99, 99}), 3 * 39 + 2 * 29, 1e-9);
}

}  // namespace
}  // namespace plumbline
