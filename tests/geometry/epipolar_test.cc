// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/epipolar.h"

#include "tests/support/random_geometry.h"
#include <cmath>

#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

Rigid3 SmallMotion() { return {ExpSo3({0.02, -0.05, 0.03}), {0.3, 0.1, 0.05}}; }

Eigen::Vector3d PointInView(Rng& rng) {
  const double z = rng.Uniform(2, 6);
  return {rng.Uniform(-0.5, 0.5) * z, rng.Uniform(-0.4, 0.4) * z, z};
}

TEST(EssentialMatrix, HoldsTheRaysOfAPointTogether) {
  Rng rng(1);
  for (int i = 0; i < 30; ++i) {
    const Rigid3 motion = RandomRigid(rng);
    const Eigen::Vector3d p = RandomVector<3>(rng);
    EXPECT_NEAR((motion * p).dot(EssentialMatrix(motion) * p), 0, 1e-13);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(EssentialMatrix(motion));
    EXPECT_NEAR(svd.singularValues()(0), svd.singularValues()(1), 1e-13);
    EXPECT_NEAR(svd.singularValues()(2), 0, 1e-13);
  }
}

TEST(FundamentalMatrix, HoldsTheirPixelsTogether) {
  const RectifiedCamera camera = TestCamera();
  const Eigen::Matrix3d F = FundamentalMatrix(camera, SmallMotion());
  Rng rng(2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d p = PointInView(rng);
    const Eigen::Vector2d a = camera.Project(p);
    const Eigen::Vector2d b = camera.Project(SmallMotion() * p);
    EXPECT_NEAR(*SquaredSampsonDistance(F, a, b), 0, 1e-18);
  }
}

TEST(SampsonDistance, IsChiSquareWithOneDegreeOfFreedom) {
  const RectifiedCamera camera = TestCamera();
  const Eigen::Matrix3d F = FundamentalMatrix(camera, SmallMotion());
  Rng rng(3);
  double sum = 0;
  int within = 0;
  constexpr int kCount = 20000;
  constexpr double kSigma = 0.7;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d p = PointInView(rng);
    const Eigen::Vector2d a = camera.Project(p) + RandomVector<2>(rng, kSigma);
    const Eigen::Vector2d b = camera.Project(SmallMotion() * p) + RandomVector<2>(rng, kSigma);
    const double chi2 = *SquaredSampsonDistance(F, a, b) / (kSigma * kSigma);
    sum += chi2;
    within += chi2 < 3.841 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 1, 0.04);
  EXPECT_NEAR(static_cast<double>(within) / kCount, 0.95, 0.006);
}

TEST(SampsonDistance, IsUndefinedWithoutMotion) {
  const Eigen::Matrix3d F = FundamentalMatrix(TestCamera(), Rigid3{});
  EXPECT_FALSE(SquaredSampsonDistance(F, {100, 100}, {100, 100}));
}

TEST(EpipolarOverlap, ComparesThePiecesOfALine) {
  const RectifiedCamera camera = TestCamera();
  const Rigid3 motion{ExpSo3({0.02, -0.05, 0.03}), {0.4, 0.05, 0}};
  const Eigen::Matrix3d F = FundamentalMatrix(camera, motion);
  // A slanted upright line; pieces by the height.
  const auto at = [](double y) { return Eigen::Vector3d(0.2 + 0.1 * y, y, 3 + 0.4 * y); };
  const auto in_a = [&](double y0, double y1) {
    return Segment2{camera.Project(at(y0)), camera.Project(at(y1))};
  };
  const auto in_b = [&](double y0, double y1) {
    return Segment2{camera.Project(motion * at(y0)), camera.Project(motion * at(y1))};
  };
  EXPECT_NEAR(*EpipolarOverlap(F, in_a(-1, 1), in_b(-1, 1)), 1, 1e-9);
  EXPECT_NEAR(*EpipolarOverlap(F, in_a(-1, 1), in_b(1, -1)), 1, 1e-9);
  EXPECT_NEAR(*EpipolarOverlap(F, in_a(-1, 1), in_b(-0.5, 0.1)), 1, 1e-9);
  EXPECT_NEAR(*EpipolarOverlap(F, in_a(-1, -0.1), in_b(0.1, 1)), 0, 1e-9);
  const double half = *EpipolarOverlap(F, in_a(-1, 0), in_b(-0.5, 0.5));
  EXPECT_GT(half, 0.4);
  EXPECT_LT(half, 0.6);
}

TEST(EpipolarOverlap, RefusesSegmentsAlongTheEpipolarLines) {
  const Eigen::Matrix3d F =
      FundamentalMatrix(TestCamera(), {Eigen::Quaterniond::Identity(), {-0.11, 0, 0}});
  EXPECT_FALSE(EpipolarOverlap(F, {{100, 200}, {300, 201}}, {{90, 200}, {280, 201}}));
  EXPECT_TRUE(EpipolarOverlap(F, {{100, 200}, {300, 240}}, {{90, 200}, {280, 240}}));
  EXPECT_FALSE(EpipolarOverlap(F, {{100, 200}, {100, 200}}, {{90, 200}, {280, 240}}));
}

}  // namespace
}  // namespace plumbline
