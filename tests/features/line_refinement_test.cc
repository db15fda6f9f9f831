// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_refinement.h"

#include "plumbline/base/random.h"

#include "tests/features/render.h"
#include <cmath>
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

LineFeature Line(const Segment2& segment) {
  LineFeature line;
  line.segment = segment;
  line.response = 10;
  return line;
}

TEST(CollinearIndex, FindsWhatLookingAtAllFinds) {
  Rng rng(1, "lines");
  std::vector<LineFeature> lines;
  for (int i = 0; i < 400; ++i) {
    // Many almost along the x axis, either way: there angles wrap round.
    const double angle = (i % 2 == 0 ? std::numbers::pi : 0) + rng.Normal(0.03);
    const Eigen::Vector2d middle(rng.Uniform(0, 600), rng.Uniform(0, 20));
    const Eigen::Vector2d half = 20 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    lines.push_back(Line({middle - half, middle + half}));
  }
  const LineMergeLimits limits{2, 1.5, 0.2};
  const CollinearIndex index(lines);
  std::size_t found = 0;
  for (const LineFeature& line : lines) {
    std::vector<std::size_t> expected;
    const Eigen::Vector3d through = LineThrough(line.segment);
    for (std::size_t j = 0; j < lines.size(); ++j) {
      const Segment2& other = lines[j].segment;
      const double cosine = line.segment.Direction().dot(other.Direction());
      if (cosine < std::cos(2 * std::numbers::pi / 180)) continue;
      if (std::abs(LineDistance(through, other.Midpoint())) > 1.5) continue;
      expected.push_back(j);
    }
    EXPECT_EQ(index.Near(line.segment, limits), expected);
    found += expected.size();
  }
  EXPECT_GT(found, 2 * lines.size());
}

TEST(Join, CoversBothPiecesOfOneLine) {
  const GradientImage gradient{Image<std::int16_t>(300, 100), Image<std::int16_t>(300, 100)};
  const LineFeature a = Line({{100, 50}, {200, 50}});
  const LineMergeLimits limits{1.5, 1.2, 0.15};
  const auto joined = Join(gradient, a, Line({{201.5, 50.4}, {260, 50.6}}), limits);
  ASSERT_TRUE(joined);
  EXPECT_EQ(joined->start, Eigen::Vector2d(100, 50));
  EXPECT_EQ(joined->end, Eigen::Vector2d(260, 50.6));
  // Overlapping, on the other side.
  const auto before = Join(gradient, a, Line({{60, 50}, {120, 50.2}}), limits);
  ASSERT_TRUE(before);
  EXPECT_EQ(before->start, Eigen::Vector2d(60, 50));
  EXPECT_EQ(before->end, Eigen::Vector2d(200, 50));
  EXPECT_FALSE(Join(gradient, a, Line({{260, 50}, {202, 50}}), limits)) << "the other way";
  EXPECT_FALSE(Join(gradient, a, Line({{201, 52}, {260, 52}}), limits)) << "beside";
  EXPECT_FALSE(Join(gradient, a, Line({{201, 50}, {230, 51.5}}), limits)) << "turned";
  EXPECT_FALSE(Join(gradient, a, Line({{230, 50}, {290, 50}}), limits)) << "far";
  EXPECT_FALSE(Join(gradient, a, Line({{206, 50}, {266, 50}}), limits)) << "no edge between";
}

}  // namespace

}  // namespace plumbline
