// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/feature_correction.h"

#include "plumbline/features/single_precision.h"

#include "tests/support/random_geometry.h"
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {
namespace feature_correction_test {

TEST(FeatureCorrection, TakesItselfOutOfDisparitiesAndRightLines) {
  const RectifiedCamera camera = TestCamera();
  Vector6d k;
  k << 0.5, 0, 0, 0, 0, 0;
  const FeatureCorrection none, half{{camera, k}};
  Features features;
  features.points.resize(2);
  features.points[0].px = {300, 200};
  features.point_disparity = {Disparity{20, 1}, std::nullopt};
  features.lines.resize(1);
  features.line_right = {RightLine{{{200, 100}, {210, 180}}, 1}};
  Correct(none, half, features);
  EXPECT_DOUBLE_EQ(features.point_disparity[0]->px, 19.5);
  EXPECT_FALSE(features.point_disparity[1]);
  EXPECT_DOUBLE_EQ(features.line_right[0]->segment.start.x(), 200.5);
  EXPECT_DOUBLE_EQ(features.line_right[0]->segment.end.x(), 210.5);
  EXPECT_DOUBLE_EQ(features.line_right[0]->segment.end.y(), 180);
  Correct(half, none, features);
  EXPECT_DOUBLE_EQ(features.point_disparity[0]->px, 20);
  EXPECT_DOUBLE_EQ(features.line_right[0]->segment.start.x(), 200);
}

// Features all over the image, as a front end measures them.
Features MeasuredAnywhere(const RectifiedCamera& camera, Rng& rng) {
  Features f;
  for (int i = 0; i < 500; ++i) {
    PointFeature point;
    point.px = {rng.Uniform(0, camera.width), rng.Uniform(0, camera.height)};
    f.points.push_back(point);
    f.point_disparity.emplace_back(Disparity{rng.Uniform(0.05, 120), 0.3});
    const Eigen::Vector2d start(rng.Uniform(0, camera.width), rng.Uniform(0, camera.height));
    f.lines.emplace_back();
    f.lines.back().segment = {start + RandomVector<2>(rng, 30), start};
    f.lines.back().sigma_px = f.points.back().sigma_px = rng.Uniform(0.3, 4);
    f.line_right.emplace_back(RightLine{{start, start + RandomVector<2>(rng, 60)}, 0.5});
  }
  RoundToSinglePrecision(f);
  return f;
}

void ExpectSameBits(const Features& a, const Features& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].px, b.points[i].px) << i;
    EXPECT_EQ(a.points[i].sigma_px, b.points[i].sigma_px) << i;
    EXPECT_EQ(a.lines[i].segment.start, b.lines[i].segment.start) << i;
    EXPECT_EQ(a.lines[i].segment.end, b.lines[i].segment.end) << i;
    EXPECT_EQ(a.lines[i].sigma_px, b.lines[i].sigma_px) << i;
    EXPECT_EQ(a.point_disparity[i]->px, b.point_disparity[i]->px) << i;
    EXPECT_EQ(a.line_right[i]->segment.start, b.line_right[i]->segment.start) << i;
    EXPECT_EQ(a.line_right[i]->segment.end, b.line_right[i]->segment.end) << i;
  }
}

TEST(FeatureCorrection, DoesNotDependOnTheCorrectionsBefore) {
  const RectifiedCamera camera = TestCamera();
  Rng rng(5);
  const Features measured = MeasuredAnywhere(camera, rng);
  Features corrected = measured;
  FeatureCorrection before;
  for (int round = 0; round < 20; ++round) {
    const FeatureCorrection next{{camera, RandomVector<6>(rng, 0.8)},
                                 {camera, rng.Uniform(-20, 20)}};
    Correct(before, next, corrected);
    before = next;
    Features at_once = measured;
    Correct({}, next, at_once);
    ExpectSameBits(corrected, at_once);
  }
  Correct(before, {}, corrected);
  ExpectSameBits(corrected, measured);
}

TEST(FeatureCorrection, TakesTheLensOutOfPointsAndLeftLines) {
  const RectifiedCamera camera = TestCamera();
  const FeatureCorrection lens{{}, {camera, 4}};
  const Eigen::Vector2d side(camera.cx + 0.5 * camera.width, camera.cy);
  Features features;
  features.points.resize(1);
  features.points[0] = {.px = side, .sigma_px = 2};
  features.point_disparity.resize(1);
  features.lines.resize(1);
  features.lines[0].segment = {side, {camera.cx, camera.cy}};
  features.line_right.resize(1);
  Correct({}, lens, features);
  EXPECT_NEAR(features.points[0].px.x(), side.x() - 4, 1e-4);
  EXPECT_DOUBLE_EQ(features.points[0].sigma_px, 2 * lens.lens.ScaleAt(side));
  EXPECT_NEAR(features.lines[0].segment.start.x(), side.x() - 4, 1e-4);
  EXPECT_EQ(features.lines[0].segment.end.x(), camera.cx);
}

TEST(FeatureCorrection, IsPlausibleWhereBothPartsAre) {
  const RectifiedCamera camera = TestCamera();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(FeatureCorrection{}.IsPlausible());
  EXPECT_FALSE((FeatureCorrection{{}, {camera, kNaN}}.IsPlausible()));
  EXPECT_FALSE((FeatureCorrection{{camera, Vector6d::Constant(kNaN)}, {}}.IsPlausible()));
}

}  // namespace feature_correction_test
}  // namespace plumbline
