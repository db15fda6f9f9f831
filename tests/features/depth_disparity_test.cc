// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/depth_disparity.h"

#include "tests/features/render.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

PointFeature PointAt(double x, double y) {
  PointFeature point;
  point.px = {x, y};
  return point;
}

LineFeature LineFrom(const Eigen::Vector2d& start, const Eigen::Vector2d& end) {
  LineFeature line;
  line.segment = {start, end};
  line.sigma_px = 0.5;
  return line;
}

DepthImage DepthOf(const std::function<double(double, double)>& z) {
  DepthImage depth(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) depth.at(x, y) = static_cast<float>(z(x, y));
  }
  return depth;
}

TEST(PointDisparities, FollowDepthAndItsNoise) {
  const RectifiedCamera camera = TestCamera(kWidth, kHeight);  // fx b = 30
  const DepthImage depth = DepthOf([](double, double) { return 2.0; });
  const auto d = PointDisparities(camera, depth, {PointAt(100.4, 50.2)}, {});
  ASSERT_TRUE(d[0]);
  EXPECT_NEAR(d[0]->px, 15, 1e-6);
  EXPECT_NEAR(d[0]->sigma_px, 30 / 4.0 * (0.0012 + 0.0019 * 1.6 * 1.6), 1e-6);
}

TEST(PointDisparities, AreMissingAtHolesEdgesAndBeyondTheRange) {
  const RectifiedCamera camera = TestCamera(kWidth, kHeight);
  const DepthImage depth = DepthOf([](double x, double y) {
    if (y > 200) return 0.0;
    if (y > 150) return 9.0;
    return x < 100 ? 1.0 : 2.0;
  });
  const auto d = PointDisparities(camera,
                                  depth,
                                  {PointAt(50, 220),
                                   PointAt(50, 170),
                                   PointAt(100, 50),
                                   PointAt(99, 50),
                                   PointAt(-3, 50),
                                   PointAt(97, 50)},
                                  {});
  for (std::size_t i = 0; i < 5; ++i) EXPECT_FALSE(d[i]) << i;
  EXPECT_TRUE(d[5]);
}

TEST(PointDisparities, BridgeASingleMissingPixel) {
  DepthImage depth = DepthOf([](double, double) { return 2.0; });
  depth.at(100, 50) = 0;
  const auto d = PointDisparities(TestCamera(kWidth, kHeight), depth, {PointAt(100, 50)}, {});
  ASSERT_TRUE(d[0]);
  EXPECT_NEAR(d[0]->px, 15, 1e-6);
}

TEST(VirtualRightLines, LieOnASlantedPlane) {
  const RectifiedCamera camera = TestCamera(kWidth, kHeight);
  // Disparity is affine in the image of a plane: 10 + x / 100 + y / 50.
  const DepthImage depth = DepthOf([](double x, double y) { return 30 / (10 + x / 100 + y / 50); });
  const auto lines = VirtualRightLines(camera, depth, {LineFrom({60, 40}, {200, 180})}, {});
  ASSERT_TRUE(lines[0]);
  EXPECT_NEAR(lines[0]->segment.start.x(), 60 - (10 + 0.6 + 0.8), 0.03);
  EXPECT_NEAR(lines[0]->segment.end.x(), 200 - (10 + 2.0 + 3.6), 0.03);
  EXPECT_EQ(lines[0]->segment.start.y(), 40);
  EXPECT_EQ(lines[0]->segment.end.y(), 180);
  EXPECT_GT(lines[0]->sigma_px, 0.5);
}

TEST(VirtualRightLines, BelongToTheNearerSurfaceAtAnEdge) {
  const RectifiedCamera camera = TestCamera(kWidth, kHeight);
  for (const bool near_is_left : {true, false}) {
    const DepthImage depth =
        DepthOf([&](double x, double) { return (x < 100) == near_is_left ? 1.5 : 4.0; });
    const auto lines = VirtualRightLines(camera, depth, {LineFrom({99.5, 40}, {99.5, 180})}, {});
    ASSERT_TRUE(lines[0]) << near_is_left;
    EXPECT_NEAR(lines[0]->segment.start.x(), 99.5 - 20, 0.05) << near_is_left;
  }
}

TEST(VirtualRightLines, AreMissingOnCurvedAndEmptyDepth) {
  const RectifiedCamera camera = TestCamera(kWidth, kHeight);
  const LineFeature line = LineFrom({40, 120}, {280, 120});
  const DepthImage bent =
      DepthOf([](double x, double) { return 2 + 0.0001 * (x - 160) * (x - 160); });
  EXPECT_FALSE(VirtualRightLines(camera, bent, {line}, {})[0]);
  EXPECT_FALSE(VirtualRightLines(camera, DepthImage(kWidth, kHeight, 0), {line}, {})[0]);
}

TEST(VirtualRightLines, IgnoreAThirdOfBadDepths) {
  const RectifiedCamera camera = TestCamera(kWidth, kHeight);
  const DepthImage depth = DepthOf([](double x, double) { return x < 100 ? 3.0 : 2.0; });
  const auto lines = VirtualRightLines(camera, depth, {LineFrom({40, 120}, {240, 120})}, {});
  ASSERT_TRUE(lines[0]);
  EXPECT_NEAR(lines[0]->segment.start.x(), 40 - 15, 0.05);
  EXPECT_NEAR(lines[0]->segment.end.x(), 240 - 15, 0.05);
}

}  // namespace
}  // namespace plumbline
