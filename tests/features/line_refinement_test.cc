// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_refinement.h"

#include "plumbline/base/random.h"

#include "tests/features/render.h"
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(RefineSegment, MovesOntoTheEdgeAtEveryAngle) {
  for (int degrees = 7; degrees < 360; degrees += 15) {  // no angle of the sampling lattice
    const double angle = degrees * std::numbers::pi / 180;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d left(direction.y(), -direction.x());
    const Eigen::Vector2d center(60.25, 59.5);
    const GrayImage image = Render(120, 120, [&](const Eigen::Vector2d& p) {
      return left.dot(p - center) > 0 ? 180.0 : 70.0;
    });
    const Segment2 rough{center - 40 * direction + 1.5 * left, center + 40 * direction - 1 * left};
    const auto once = RefineSegment(ComputeGradient(image), rough, 3);
    ASSERT_TRUE(once) << degrees;
    const auto refined = RefineSegment(ComputeGradient(image), once->segment, 2);
    ASSERT_TRUE(refined) << degrees;
    EXPECT_NEAR(left.dot(refined->segment.start - center), 0, 0.08) << degrees;
    EXPECT_NEAR(left.dot(refined->segment.end - center), 0, 0.08) << degrees;
    EXPECT_LT(refined->sigma_px, 0.2);
  }
}

TEST(RefineSegment, IgnoresAPieceOfAnotherEdge) {
  // On a quarter of the length the edge is displaced by two pixels.
  const GrayImage image = Render(120, 120, [](const Eigen::Vector2d& p) {
    return p.x() > (p.y() < 85 ? 60.25 : 62.25) ? 180.0 : 70.0;
  });
  const auto refined = RefineSegment(ComputeGradient(image), {{60, 10}, {60, 110}}, 3);
  ASSERT_TRUE(refined);
  EXPECT_NEAR(refined->segment.start.x(), 60.25, 0.1);
  EXPECT_NEAR(refined->segment.end.x(), 60.25, 0.1);
}

TEST(RefineSegment, GivesUpWithoutAnEdge) {
  const GradientImage flat = ComputeGradient(GrayImage(120, 120, 90));
  EXPECT_FALSE(RefineSegment(flat, {{60, 10}, {60, 110}}, 3));
  EXPECT_FALSE(RefineSegment(flat, {{60, 10}, {60, 10}}, 3));
  EXPECT_FALSE(RefineSegment(flat, {{-500, 10}, {-300, 10}}, 3));
  // An edge of the other sign is another edge.
  const GradientImage other = ComputeGradient(
      Render(120, 120, [](const Eigen::Vector2d& p) { return p.x() > 60.25 ? 70.0 : 180.0; }));
  EXPECT_FALSE(RefineSegment(other, {{60, 10}, {60, 110}}, 3));
}

TEST(RefineSegment, PredictsItsScatterUnderNoise) {
  Rng rng(3, "noise");
  double squares = 0;
  double predicted = 0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    GrayImage image =
        Render(100, 100, [](const Eigen::Vector2d& p) { return p.x() > 50.25 ? 140.0 : 100.0; });
    for (int i = 0; i < 100 * 100; ++i) {
      std::uint8_t& pixel = image.data()[i];
      pixel = static_cast<std::uint8_t>(std::lround(pixel + rng.Normal(5)));
    }
    const auto refined = RefineSegment(ComputeGradient(image), {{50, 10}, {50, 90}}, 3);
    ASSERT_TRUE(refined);
    squares += std::pow(refined->segment.start.x() - 50.25, 2);
    predicted += refined->sigma_px;
  }
  const double actual = std::sqrt(squares / kTrials);
  EXPECT_GT(predicted / kTrials, 0.4 * actual);
  EXPECT_LT(predicted / kTrials, 2.5 * actual);
}

TEST(MeanNormalGradient, HasTheSignOfLineDistance) {
  const GradientImage gradient = ComputeGradient(
      Render(320, 240, [](const Eigen::Vector2d& p) { return p.x() > 151.25 ? 160.0 : 60.0; }));
  EXPECT_LT(MeanNormalGradient(gradient, {{151.25, 50}, {151.25, 150}}), -10);
  EXPECT_GT(MeanNormalGradient(gradient, {{151.25, 150}, {151.25, 50}}), 10);
  EXPECT_EQ(MeanNormalGradient(gradient, {{5, 5}, {5, 5}}), 0);
}

}  // namespace
}  // namespace plumbline
