// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/image_motion.h"

#include "plumbline/base/random.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Eigen::Vector2d RandomPixel(Rng& rng) {
  const double x = rng.Uniform(0, 640);
  return {x, rng.Uniform(0, 480)};
}

Eigen::Vector2d TurnedAndShifted(const Eigen::Vector2d& px) {
  const double angle = 0.2;
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return 1.1 * turn * (px - Eigen::Vector2d(320, 240)) + Eigen::Vector2d(360, 215);
}

TEST(ImageMotion, DefaultMovesNothing) {
  const ImageMotion motion;
  EXPECT_FALSE(motion.known());
  EXPECT_EQ(motion(Eigen::Vector2d(3, 4)), Eigen::Vector2d(3, 4));
}

TEST(ImageMotion, OnePairShiftsEverything) {
  const std::vector<PixelPair> pairs{{{10, 10}, {15, 7}}};
  const ImageMotion motion(pairs);
  EXPECT_TRUE(motion.known());
  EXPECT_LT((motion(Eigen::Vector2d(100, 200)) - Eigen::Vector2d(105, 197)).norm(), 1e-9);
}

TEST(ImageMotion, AffineMapIsFoundAmongWrongMatches) {
  Rng rng(1);
  std::vector<PixelPair> pairs;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d from = RandomPixel(rng);
    const bool wrong = i % 4 == 0;
    pairs.push_back({from, wrong ? RandomPixel(rng) : TurnedAndShifted(from)});
  }
  const ImageMotion motion(pairs);
  int right = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d px = RandomPixel(rng);
    right += (motion(px) - TurnedAndShifted(px)).norm() < 2 ? 1 : 0;
  }
  EXPECT_GE(right, 93);  // elsewhere most neighbours are wrong
}

TEST(ImageMotion, NearThingsMoveAsTheirNeighbours) {
  Rng rng(1);
  const auto moved = [](const Eigen::Vector2d& px) {  // a near object on the left
    return Eigen::Vector2d(px.x() + (px.x() < 200 ? 60 : 10), px.y());
  };
  std::vector<PixelPair> pairs;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d from = RandomPixel(rng);
    pairs.push_back({from, moved(from)});
  }
  const ImageMotion motion(pairs);
  EXPECT_LT((motion({80, 240}) - moved({80, 240})).norm(), 4);
  EXPECT_LT((motion({500, 100}) - moved({500, 100})).norm(), 4);
  const Segment2 segment = motion(Segment2{{80, 100}, {100, 300}});
  EXPECT_LT((segment.start - Eigen::Vector2d(140, 100)).norm(), 4);
  EXPECT_LT((segment.end - Eigen::Vector2d(160, 300)).norm(), 4);
}

}  // namespace
}  // namespace plumbline
