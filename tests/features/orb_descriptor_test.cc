// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/orb_descriptor.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"
#include "plumbline/image/opencv_bridge.h"

#include "tests/features/render.h"
#include <algorithm>
#include <cstring>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

namespace plumbline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

GrayImage Texture() { return Render(320, 240, SquareTexture(150, 320, 240)); }

std::vector<OrientedPixel> Corners() {
  Rng rng(1, "orb_descriptor");
  std::vector<OrientedPixel> corners;
  for (int i = 0; i < 300; ++i) {
    corners.push_back({30 + static_cast<int>(rng.Index(260)),
                       30 + static_cast<int>(rng.Index(180)),
                       rng.Uniform(-std::numbers::pi, std::numbers::pi)});
  }
  return corners;
}

TEST(OrbDescriptor, IsThatOfOpenCvButForRounding) {
  const GrayImage image = Texture();
  const std::vector<OrientedPixel> corners = Corners();
  std::vector<cv::KeyPoint> keypoints;
  for (const OrientedPixel& c : corners) {
    const double degrees = c.angle * kDegrees + (c.angle < 0 ? 360 : 0);
    keypoints.emplace_back(static_cast<float>(c.x),
                           static_cast<float>(c.y),
                           31.F,
                           static_cast<float>(degrees),
                           0.F,
                           0,
                           static_cast<int>(keypoints.size()));
  }
  cv::Mat rows;
  cv::ORB::create(1000, 1.2F, 1, 0)->compute(AsMat(image), keypoints, rows);
  ASSERT_EQ(rows.rows, 300);
  const std::vector<Descriptor> ours = DescribeOrb(image, corners);
  ASSERT_EQ(ours.size(), 300U);
  int most = 0;
  int sum = 0;
  for (int i = 0; i < rows.rows; ++i) {
    Descriptor theirs;
    std::memcpy(theirs.data(), rows.ptr(i), sizeof theirs);
    const auto index = static_cast<std::size_t>(keypoints[static_cast<std::size_t>(i)].class_id);
    const int distance = HammingDistance(theirs, ours[index]);
    most = std::max(most, distance);
    sum += distance;
  }
  // Grey levels that differ by one change few comparisons, except on even ground.
  EXPECT_LT(sum, 300 * 8);
  EXPECT_LT(most, 64);
}

TEST(OrbDescriptor, TurnsWithTheImage) {
  const GrayImage image = Texture();
  GrayImage turned(image.height(), image.width());  // a quarter turn, clockwise as seen
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) turned.at(image.height() - 1 - y, x) = image.at(x, y);
  }
  std::vector<OrientedPixel> corners = Corners();
  const auto upright = DescribeOrb(image, corners);
  for (OrientedPixel& c : corners) {
    c = {image.height() - 1 - c.y, c.x, c.angle + std::numbers::pi / 2};
  }
  const auto after = DescribeOrb(turned, corners);
  int sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) sum += HammingDistance(upright[i], after[i]);
  EXPECT_LT(sum, 300);  // halves of pixels are rounded the other way
}

TEST(OrbDescriptor, ComparesTheSmoothedGreyLevelsOfThePattern) {
  // Grey levels grow to the right: a bit says that the first place is left of the second.
  GrayImage ramp(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) ramp.at(x, y) = static_cast<std::uint8_t>(4 * x);
  }
  const Descriptor d = DescribeOrb(ramp, {{32, 32, 0}})[0];
  EXPECT_EQ(d[0] & 1U, 1U);          // 8 < 9
  EXPECT_EQ((d[0] >> 1U) & 1U, 1U);  // 4 < 7
  EXPECT_EQ((d[0] >> 2U) & 1U, 1U);  // -11 < -8
  const Descriptor back = DescribeOrb(ramp, {{32, 32, std::numbers::pi}})[0];
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(d[i] & back[i], 0U);
}

TEST(OrbDescriptor, RefusesCornersAtTheBorder) {
  EXPECT_TRUE(DescribeOrb(Texture(), {}).empty());
  EXPECT_NO_THROW(DescribeOrb(Texture(), {{kOrbReach, kOrbReach, 0.7}}));
  EXPECT_THROW(DescribeOrb(Texture(), {{kOrbReach - 1, 100, 0}}), BugError);
  EXPECT_THROW(DescribeOrb(Texture(), {{100, 240 - kOrbReach, 0}}), BugError);
}

}  // namespace
}  // namespace plumbline
