// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/lbd.h"

#include "tests/features/render.h"
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

Descriptor Describe(const GrayImage& image, const Segment2& segment) {
  return BinarizeLbd(ComputeLbdVector(ComputeGradient(image, 1), segment));
}

TEST(Lbd, IsTheSameForATurnedImage) {
  const SquareTexture texture(150, 320, 320);
  const Eigen::Vector2d center(160, 160);
  const Segment2 segment{{120, 150}, {200, 170}};
  const Descriptor reference = Describe(Render(320, 320, texture), segment);
  for (const double angle : {0.3, 1.2, 2.5, -2.0}) {
    const Eigen::Matrix2d turn = Eigen::Rotation2D<double>(angle).toRotationMatrix();
    const GrayImage image = Render(320, 320, [&](const Eigen::Vector2d& p) -> double {
      return texture(turn.transpose() * (p - center) + center);
    });
    const Segment2 turned{turn * (segment.start - center) + center,
                          turn * (segment.end - center) + center};
    EXPECT_LT(HammingDistance(reference, Describe(image, turned)), 40) << angle;
    EXPECT_GT(HammingDistance(reference, Describe(image, turned.Reversed())), 80) << angle;
  }
}

TEST(Lbd, DoesNotChangeWithBrightnessAndContrast) {
  const SquareTexture texture(150, 320, 240);
  const Segment2 segment{{120, 100}, {200, 140}};
  const Descriptor a = Describe(Render(320, 240, texture), segment);
  const Descriptor b = Describe(
      Render(320, 240, [&](const Eigen::Vector2d& p) { return 40 + 0.6 * texture(p); }), segment);
  EXPECT_LT(HammingDistance(a, b), 12);
}

TEST(Lbd, BothHalvesOfTheVectorHaveUnitNorm) {
  const GrayImage image = Render(320, 240, SquareTexture(150, 320, 240));
  const LbdVector v = ComputeLbdVector(ComputeGradient(image), {{120, 100}, {200, 140}});
  float mean = 0;
  float deviation = 0;
  for (std::size_t i = 0; i < v.size(); ++i) (i % 8 < 4 ? mean : deviation) += v[i] * v[i];
  EXPECT_NEAR(mean, 1, 1e-5);
  EXPECT_NEAR(deviation, 1, 1e-5);
}

TEST(Lbd, CopesWithLinesAtAndBeyondTheBorder) {
  const GrayImage image = Render(160, 120, SquareTexture(60, 160, 120));
  const GradientImage gradient = ComputeGradient(image);
  for (const Segment2& s : {Segment2{{0, 0}, {159, 0}},
                            Segment2{{159, 119}, {0, 119}},
                            Segment2{{-50, 60}, {210, 60}},
                            Segment2{{0, 0}, {300, 300}}}) {
    float sum = 0;
    for (const float v : ComputeLbdVector(gradient, s)) {
      ASSERT_TRUE(std::isfinite(v));
      sum += v;
    }
    EXPECT_GT(sum, 0);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Segment2& s : {Segment2{{5, 5}, {5, 5}},
                            Segment2{{-900, -900}, {-800, -900}},
                            Segment2{{nan, 0}, {5, 5}},
                            Segment2{{1e9, 0}, {-1e9, 5}}}) {
    EXPECT_EQ(ComputeLbdVector(gradient, s), LbdVector{});
  }
}

TEST(Lbd, ComparesBandsInOrder) {
  LbdVector falling{};
  for (std::size_t band = 0; band < kLbdBands; ++band) {
    for (std::size_t k = 0; k < 8; ++k) falling[8 * band + k] = static_cast<float>(9 - band);
  }
  const Descriptor ones = BinarizeLbd(falling);
  EXPECT_EQ(HammingDistance(ones, BinarizeLbd(LbdVector{})), 256);
}

}  // namespace
}  // namespace plumbline
