// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/frame.h"

#include "tests/support/random_geometry.h"
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(WithCorrection, CorrectsACopyAndRemembersTheCorrection) {
  auto features = std::make_shared<FrameFeatures>();
  features->features.points.resize(1);
  features->features.point_disparity = {Disparity{10, 1}};
  const std::shared_ptr<const FrameFeatures> raw = features;
  const FeatureCorrection half{{TestCamera(), 0.5 * Vector6d::Unit(0)}};
  const auto corrected = WithCorrection(raw, half);
  EXPECT_DOUBLE_EQ(raw->features.point_disparity[0]->px, 10);
  EXPECT_DOUBLE_EQ(corrected->features.point_disparity[0]->px, 9.5);
  EXPECT_EQ(corrected->correction, half);
  EXPECT_DOUBLE_EQ(WithCorrection(corrected, {})->features.point_disparity[0]->px, 10);
}

std::vector<int> PointsNear(const FrameFeatures& indexed, const Eigen::Vector2d& px) {
  std::vector<int> found;
  indexed.PointsInWindow(px, {1, 1}, &found);
  return found;
}

TEST(WithCorrection, IndexesPointsWhereTheLensCorrectionPutsThem) {
  const RectifiedCamera camera = TestCamera();
  Features measured;
  measured.points.resize(1);
  measured.points[0].px = {camera.cx + 0.5 * camera.width, camera.cy};
  measured.point_disparity.resize(1);
  const FeatureCorrection lens{{}, {camera, 4}};
  const auto raw = IndexFeatures(camera, measured);
  const Eigen::Vector2d corrected = lens.lens.At(measured.points[0].px);
  for (const auto& indexed : {WithCorrection(raw, lens), IndexFeatures(camera, measured, lens)}) {
    EXPECT_EQ(PointsNear(*indexed, corrected), std::vector<int>{0});
    EXPECT_TRUE(PointsNear(*indexed, measured.points[0].px).empty());
    EXPECT_EQ(MeasuredFeatures(*indexed).points[0].px, measured.points[0].px);
  }
}

TEST(WithCorrection, SharesFeaturesThatHaveTheCorrection) {
  const auto raw = std::make_shared<const FrameFeatures>();
  EXPECT_EQ(WithCorrection(raw, {}), raw);
}

TEST(WithRightLines, SharesFeaturesThatHaveNoLines) {
  const auto without = std::make_shared<const FrameFeatures>();
  EXPECT_EQ(WithRightLines(without, {}), without);
}

TEST(WithRightLines, GivesThemTheCorrectionOfTheRest) {
  Features measured;
  measured.lines.resize(2);
  measured.line_right.resize(2);
  const FeatureCorrection half{{TestCamera(), 0.5 * Vector6d::Unit(0)}};
  const auto without = IndexFeatures(TestCamera(), measured, half);
  MeasuredSegment right;
  right.segment = {{100, 50}, {120, 90}};
  const auto whole = WithRightLines(without, {right, std::nullopt});
  EXPECT_FALSE(without->features.line_right[0]);
  ASSERT_TRUE(whole->features.line_right[0]);
  EXPECT_FALSE(whole->features.line_right[1]);
  EXPECT_DOUBLE_EQ(whole->features.line_right[0]->segment.start.x(), 100.5);
  EXPECT_DOUBLE_EQ(MeasuredFeatures(*whole).line_right[0]->segment.start.x(), 100);
  EXPECT_EQ(whole->correction, half);
}

TEST(IndexFeatures, CorrectsWhatWasMeasuredAndFindsItAgain) {
  Features measured;
  measured.points.resize(2);
  measured.points[0].px = {300.25, 200.5};
  measured.points[1].px = {700, 400};
  measured.point_disparity = {Disparity{20.125, 1}, std::nullopt};
  Vector6d k;
  k << 0.1, -0.2, 0.3, -0.4, 0.5, -0.6;
  const FeatureCorrection correction{{TestCamera(), k}};
  const auto indexed = IndexFeatures(TestCamera(), measured, correction);
  EXPECT_EQ(indexed->correction, correction);
  EXPECT_EQ(PointsNear(*indexed, {700, 400}), std::vector<int>{1});
  EXPECT_NE(indexed->features.point_disparity[0]->px, 20.125);
  EXPECT_EQ(MeasuredFeatures(*indexed).point_disparity[0]->px, 20.125);
  EXPECT_EQ(indexed->features.point_disparity[0]->px,
            WithCorrection(IndexFeatures(TestCamera(), measured), correction)
                ->features.point_disparity[0]
                ->px);
}

}  // namespace
}  // namespace plumbline
