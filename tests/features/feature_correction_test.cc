// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/feature_correction.h"

#include "plumbline/features/single_precision.h"
#include "plumbline/geometry/segment.h"

#include "tests/support/random_geometry.h"
#include "tests/support/single_camera.h"
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace plumbline {

namespace lens_correction_test {

using Eigen::Vector2d;

TEST(LensCorrection, MovesTheSideOfTheImageByWhatItSays) {
  const RectifiedCamera camera = OneCamera();
  const LensCorrection correction(camera, 2);
  EXPECT_NEAR((correction.At({600, 90}) - Vector2d(598, 90)).norm(), 0, 1e-12);
  EXPECT_NEAR((correction.At({0, 90}) - Vector2d(2, 90)).norm(), 0, 1e-12);
  EXPECT_NEAR((correction.At({300, 90}) - Vector2d(300, 90)).norm(), 0, 1e-12);
}

TEST(LensCorrection, ScaleIsTheRootOfTheChangeOfArea) {
  const RectifiedCamera camera = OneCamera();
  const LensCorrection correction(camera, -4);
  constexpr double kStep = 1e-4;
  for (const Vector2d& px : {Vector2d(300, 90), Vector2d(500, 40), Vector2d(20, 170)}) {
    Eigen::Matrix2d J;
    for (int k = 0; k < 2; ++k) {
      const Vector2d step = kStep * Vector2d::Unit(k);
      J.col(k) = (correction.At(px + step) - correction.At(px - step)) / (2 * kStep);
    }
    EXPECT_NEAR(correction.ScaleAt(px), std::sqrt(J.determinant()), 1e-7);
  }
}

TEST(LensCorrection, IsNothingByDefault) {
  EXPECT_EQ(LensCorrection().At({500, 40}), Vector2d(500, 40));
  EXPECT_EQ(LensCorrection().ScaleAt({500, 40}), 1);
  EXPECT_EQ(LensCorrection().border_px(), 0);
}

TEST(LensCorrection, IsPlausibleUpToThreePercentOfTheWidth) {
  EXPECT_TRUE(LensCorrection().IsPlausible());
  EXPECT_TRUE(LensCorrection(OneCamera(), -17).IsPlausible());
  EXPECT_FALSE(LensCorrection(OneCamera(), 19).IsPlausible());
  EXPECT_FALSE(LensCorrection(OneCamera(), std::numeric_limits<double>::infinity()).IsPlausible());
}

// Returns the least squares line through the images of the points of a segment as a lens shows
// them, between the images of its ends.
Segment2 FittedThroughALens(const Segment2& straight, const LensCorrection& lens) {
  constexpr int kSamples = 1001;
  Eigen::MatrixX2d across(kSamples, 2);
  Eigen::MatrixX2d shown(kSamples, 2);
  for (int i = 0; i < kSamples; ++i) {
    const double t = i / (kSamples - 1.0);
    const Vector2d place = (1 - t) * straight.start + t * straight.end;
    Vector2d px = place;
    for (int round = 0; round < 50; ++round) px = place + lens.ShiftAt(px);
    shown.row(i) = px;
    across.row(i) << 1, t;
  }
  const Eigen::Matrix2d fit = across.colPivHouseholderQr().solve(shown);
  return {fit.row(0), fit.row(0) + fit.row(1)};
}

TEST(LensCorrection, TakesALineThroughABentEdgeToTheStraightOne) {
  const RectifiedCamera camera = OneCamera();
  const LensCorrection lens(camera, 6);
  const Segment2 along_the_border{{40, 10}, {560, 30}};
  const Segment2 fitted = FittedThroughALens(along_the_border, lens);
  const Segment2 corrected = lens.At(fitted);
  const auto distance = [&](const Vector2d& px) {
    return std::abs(LineDistance(LineThrough(along_the_border), px));
  };
  EXPECT_LT(distance(corrected.start), 0.05);
  EXPECT_LT(distance(corrected.end), 0.05);
  EXPECT_GT(distance(lens.At(fitted.start)), 0.5) << "where its ends alone would go";
  EXPECT_GT(distance(lens.At(fitted.end)), 0.5);
}

TEST(LensCorrection, MovesASegmentWithoutLengthLikeItsPlace) {
  const LensCorrection lens(OneCamera(), 2);
  const Segment2 moved = lens.At(Segment2{{600, 90}, {600, 90}});
  EXPECT_NEAR((moved.start - Vector2d(598, 90)).norm(), 0, 1e-12);
  EXPECT_NEAR((moved.end - Vector2d(598, 90)).norm(), 0, 1e-12);
}

}  // namespace lens_correction_test

namespace {

TEST(StereoCorrection, IsAQuadraticPolynomialAroundThePrincipalPoint) {
  const RectifiedCamera camera = TestCamera();
  Vector6d k;
  k << 0.1, -0.2, 0.3, -0.4, 0.5, -0.6;
  const StereoCorrection correction(camera, k);
  EXPECT_DOUBLE_EQ(correction.At({camera.cx, camera.cy}), 0.1);
  const double unit = 0.5 * camera.width;
  const double x = 0.7, y = -0.3;
  EXPECT_NEAR(correction.At({camera.cx + x * unit, camera.cy + y * unit}),
              0.1 - 0.2 * x + 0.3 * y - 0.4 * x * x + 0.5 * x * y - 0.6 * y * y,
              1e-12);
  EXPECT_NEAR(StereoCorrection::Terms(camera, {camera.cx + x * unit, camera.cy + y * unit}).dot(k),
              correction.At({camera.cx + x * unit, camera.cy + y * unit}),
              1e-12);
}

TEST(StereoCorrection, IsNothingByDefault) {
  const StereoCorrection none;
  EXPECT_EQ(none.At({100, 50}), 0);
  EXPECT_EQ(none, StereoCorrection());
}

}  // namespace

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
  features.line_right = {MeasuredSegment{{{200, 100}, {210, 180}}, 1}};
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
    f.point_disparity.push_back(Disparity{rng.Uniform(0.05, 120), 0.3});
    const Eigen::Vector2d start(rng.Uniform(0, camera.width), rng.Uniform(0, camera.height));
    f.lines.emplace_back();
    f.lines.back().segment = {start + RandomVector<2>(rng, 30), start};
    f.lines.back().sigma_px = f.points.back().sigma_px = rng.Uniform(0.3, 4);
    f.line_right.push_back(MeasuredSegment{{start, start + RandomVector<2>(rng, 60)}, 0.5});
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
