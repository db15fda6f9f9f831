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
    EXPECT_NEAR(gradient.dx.at(17, 12) / kSobelGain, 3, 0.1);
    EXPECT_NEAR(gradient.dy.at(17, 12) / kSobelGain, 2, 0.1);
  }
}

}  // namespace
}  // namespace plumbline
