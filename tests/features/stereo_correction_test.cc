// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/stereo_correction.h"

#include "plumbline/features/single_precision.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
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

TEST(StereoCorrection, TakesItselfOutOfDisparitiesAndRightLines) {
  const RectifiedCamera camera = TestCamera();
  Vector6d k;
  k << 0.5, 0, 0, 0, 0, 0;
  const StereoCorrection none, half(camera, k);
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
    f.line_right.emplace_back(RightLine{{start, start + RandomVector<2>(rng, 60)}, 0.5});
  }
  RoundToSinglePrecision(f);
  return f;
}

void ExpectSameBits(const Features& a, const Features& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.point_disparity[i]->px, b.point_disparity[i]->px) << i;
    EXPECT_EQ(a.line_right[i]->segment.start, b.line_right[i]->segment.start) << i;
    EXPECT_EQ(a.line_right[i]->segment.end, b.line_right[i]->segment.end) << i;
  }
}

TEST(StereoCorrection, DoesNotDependOnTheCorrectionsBefore) {
  const RectifiedCamera camera = TestCamera();
  Rng rng(5);
  const Features measured = MeasuredAnywhere(camera, rng);
  Features corrected = measured;
  StereoCorrection before;
  for (int round = 0; round < 20; ++round) {
    const StereoCorrection next(camera, RandomVector<6>(rng, 0.8));
    Correct(before, next, corrected);
    before = next;
    Features at_once = measured;
    Correct({}, next, at_once);
    ExpectSameBits(corrected, at_once);
  }
  Correct(before, {}, corrected);
  ExpectSameBits(corrected, measured);
}

}  // namespace
}  // namespace plumbline
