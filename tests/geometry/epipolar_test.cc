// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/epipolar.h"

#include "tests/support/random_geometry.h"

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

}  // namespace
}  // namespace plumbline
