// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/pyramid.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ImagePyramid, ShrinksByTheFactorAndStopsAtTheSmallestSide) {
  const ImagePyramid pyramid = BuildPyramid(GrayImage(200, 100, 7), 8, 1.2, 60);
  ASSERT_EQ(pyramid.size(), 3U);  // 100, 83, 69; the next would be 58
  EXPECT_EQ(pyramid[2].image.width(), 139);
  EXPECT_EQ(pyramid[2].image.height(), 69);
  EXPECT_DOUBLE_EQ(pyramid[2].scale.x(), 200.0 / 139);
  EXPECT_DOUBLE_EQ(pyramid[2].scale.y(), 100.0 / 69);
}

TEST(ImagePyramid, KeepsTheFirstLevelOfATinyImage) {
  EXPECT_EQ(BuildPyramid(GrayImage(5, 3, 7), 8, 1.2).size(), 1U);
}

TEST(ImagePyramid, PlacesGreyLevelsWhereToFullSays) {
  GrayImage ramp(240, 120);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 240; ++x) ramp.at(x, y) = static_cast<std::uint8_t>(x);
  }
  for (const PyramidLevel& level : BuildPyramid(ramp, 5, 1.2)) {
    for (int x = 5; x < level.image.width() - 5; x += 7) {
      // Each level rounds once more.
      EXPECT_NEAR(level.image.at(x, 20), level.ToFull({x, 20}).x(), 1.5);
    }
    const Eigen::Vector2d px(17.25, 60.5);
    EXPECT_LT((level.ToFull(level.FromFull(px)) - px).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace plumbline
