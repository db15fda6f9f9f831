// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/lens_correction.h"

#include "tests/support/single_camera.h"
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace plumbline {
namespace lens_correction_test {

using Eigen::Vector2d;

TEST(LensCorrection, MovesTheSideOfTheImageByWhatItSays) {
  const RectifiedCamera camera = OneCamera();
  const LensCorrection correction(camera, 2);
  EXPECT_NEAR((correction.At({600, 90}) - Vector2d(598, 90)).norm(), 0, 1e-12);
  EXPECT_NEAR((correction.At({0, 90}) - Vector2d(2, 90)).norm(), 0, 1e-12);
  EXPECT_NEAR((correction.At({300, 90}) - Vector2d(300, 90)).norm(), 0, 1e-12);
}

TEST(LensCorrection, ScaleIsTheRootOfTheChangeOfArea) {
  const RectifiedCamera camera = OneCamera();
  const LensCorrection correction(camera, -4);
  constexpr double kStep = 1e-4;
  for (const Vector2d& px : {Vector2d(300, 90), Vector2d(500, 40), Vector2d(20, 170)}) {
    Eigen::Matrix2d J;
    for (int k = 0; k < 2; ++k) {
      const Vector2d step = kStep * Vector2d::Unit(k);
      J.col(k) = (correction.At(px + step) - correction.At(px - step)) / (2 * kStep);
    }
    EXPECT_NEAR(correction.ScaleAt(px), std::sqrt(J.determinant()), 1e-7);
  }
}

TEST(LensCorrection, IsNothingByDefault) {
  EXPECT_EQ(LensCorrection().At({500, 40}), Vector2d(500, 40));
  EXPECT_EQ(LensCorrection().ScaleAt({500, 40}), 1);
  EXPECT_EQ(LensCorrection().border_px(), 0);
}

TEST(LensCorrection, IsPlausibleUpToThreePercentOfTheWidth) {
  EXPECT_TRUE(LensCorrection().IsPlausible());
  EXPECT_TRUE(LensCorrection(OneCamera(), -17).IsPlausible());
  EXPECT_FALSE(LensCorrection(OneCamera(), 19).IsPlausible());
  EXPECT_FALSE(LensCorrection(OneCamera(), std::numeric_limits<double>::infinity()).IsPlausible());
}

}  // namespace lens_correction_test
}  // namespace plumbline
