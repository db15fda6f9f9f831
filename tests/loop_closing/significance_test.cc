// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/significance.h"

#include "tests/support/synthetic_world.h"
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Log10BinomialTail, IsThatOfSmallCasesByHand) {
  EXPECT_NEAR(Log10BinomialTail(2, 1, 0.5), std::log10(0.75), 1e-12);
  EXPECT_NEAR(Log10BinomialTail(3, 3, 0.1), -3, 1e-12);
  EXPECT_NEAR(Log10BinomialTail(10, 9, 0.3),
              std::log10(10 * std::pow(0.3, 9) * 0.7 + std::pow(0.3, 10)),
              1e-9);
}

TEST(Log10BinomialTail, IsCertainOrImpossibleAtTheEnds) {
  EXPECT_EQ(Log10BinomialTail(10, 0, 0.1), 0);
  EXPECT_EQ(Log10BinomialTail(10, 5, 1), 0);
  EXPECT_EQ(Log10BinomialTail(10, 1, 0), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(Log10BinomialTail(10, 11, 0.5), -std::numeric_limits<double>::infinity());
}

TEST(Log10BinomialTail, OfThousandsOfTrialsIsFinite) {
  const double tail = Log10BinomialTail(5000, 3000, 0.05);
  EXPECT_TRUE(std::isfinite(tail));
  EXPECT_LT(tail, -1000);
}

// An image of points on a grid, and the same points as landmarks.
struct GridImage {
  RectifiedCamera camera = TestCamera();
  std::shared_ptr<const FrameFeatures> image;
  std::vector<std::optional<ProjectedPoint>> points;

  explicit GridImage(bool alike) {
    Rng rng(1, "grid_image");
    const Descriptor same = RandomDescriptor(rng);
    Features features;
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 12; ++x) {
        PointFeature feature;
        feature.px = {60.0 * x + 30, 55.0 * y + 30};
        feature.descriptor = alike ? same : RandomDescriptor(rng);
        features.points.push_back(feature);
        ProjectedPoint point;
        point.px = feature.px;
        point.descriptor = feature.descriptor;
        points.emplace_back(point);
      }
    }
    features.point_disparity.resize(features.points.size());
    image = IndexFeatures(camera, features);
  }

  int Shifted() const { return BestShiftedMatches(camera, *image, points, 64, 4); }
};

TEST(BestShiftedMatches, FindsWhatRepeats) {
  // One step along a row of 12: 11 of 12 find another.
  EXPECT_GE(GridImage(true).Shifted(), 11 * 8);
}

TEST(BestShiftedMatches, FindsLittleWhereAllLooksDifferent) {
  EXPECT_LE(GridImage(false).Shifted(), 2);
}

}  // namespace
}  // namespace plumbline
