// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/homography.h"

#include "plumbline/base/statistics.h"

#include "tests/solvers/two_view_scene.h"
#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace homography_test {

using testing::MakeTwoViewScene;
using testing::SceneKind;
using testing::TwoViewScene;

const Eigen::Vector3d kNormal = Eigen::Vector3d(0.3, -0.2, 1).normalized();
const double kDistance = 4 / Eigen::Vector3d(0.3, -0.2, 1).norm();

TwoViewScene PlaneScene(std::uint64_t seed, int points, double noise = 0) {
  return MakeTwoViewScene(seed, {.kind = SceneKind::kPlane, .points = points, .noise = noise});
}

// R + t n^T / d of the scenes above.
Eigen::Matrix3d TrueHomography(const TwoViewScene& scene) {
  const Eigen::Vector3d t = testing::TranslationOf(SceneKind::kPlane);
  return scene.b_from_a.rotation.toRotationMatrix() + t / kDistance * kNormal.transpose();
}

double Difference(const Eigen::Matrix3d& G, const Eigen::Matrix3d& H) {
  return std::min((G.normalized() - H.normalized()).norm(),
                  (G.normalized() + H.normalized()).norm());
}

TEST(Homography, OfFourExactPointsIsTrue) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const TwoViewScene scene = PlaneScene(seed, 4);
    const auto H = HomographyFromFourPoints(std::span<const RayMatch, 4>(scene.matches.data(), 4));
    ASSERT_TRUE(H);
    EXPECT_LT(Difference(*H, TrueHomography(scene)), 1e-7);
  }
}

TEST(Homography, OfThreePointsOnALineIsNone) {
  TwoViewScene scene = PlaneScene(1, 4);
  scene.matches[2].a = 0.5 * (scene.matches[0].a + scene.matches[1].a);
  EXPECT_FALSE(HomographyFromFourPoints(std::span<const RayMatch, 4>(scene.matches.data(), 4)));
}

TEST(Homography, OfManyPointsAveragesTheNoise) {
  const TwoViewScene exact = PlaneScene(1, 40);
  const auto from_exact = HomographyFromPoints(exact.matches);
  ASSERT_TRUE(from_exact);
  EXPECT_LT(Difference(*from_exact, TrueHomography(exact)), 1e-9);
  const TwoViewScene noisy = PlaneScene(1, 400, 1);
  const auto start = HomographyFromPoints(noisy.matches);
  ASSERT_TRUE(start);
  const auto H = HomographyFromPoints(noisy.matches, &*start);
  ASSERT_TRUE(H);
  EXPECT_LT(Difference(*H, TrueHomography(noisy)), 2e-3);
}

TEST(Homography, TransferErrorIsChiSquareWithTwoDegrees) {
  const TwoViewScene scene = PlaneScene(3, 4000, 1);
  const Eigen::Matrix3d H = TrueHomography(scene);
  double below = 0;
  double sum = 0;
  for (const RayMatch& match : scene.matches) {
    const double chi2 = SquaredTransferError(H, match);
    EXPECT_NEAR(chi2, SquaredTransferError(-2 * H, match), 1e-9 * (1 + chi2));
    below += chi2 < kChi2TwoDof95 ? 1 : 0;
    sum += chi2;
  }
  EXPECT_NEAR(below / 4000, 0.95, 0.012);
  EXPECT_NEAR(sum / 4000, 2, 0.1);
}

TEST(MotionsFromHomography, HaveTheTrueMotionAndAllMapTheSame) {
  Rng rng(1);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const TwoViewScene scene = PlaneScene(seed, 4);
    const Eigen::Matrix3d truth = TrueHomography(scene);
    const auto motions = MotionsFromHomography(rng.Uniform(-3, 3) * truth);
    ASSERT_EQ(motions.size(), 4U);
    int right = 0;
    for (const PlanarMotion& motion : motions) {
      EXPECT_NEAR(motion.normal.norm(), 1, 1e-9);
      const Eigen::Matrix3d H = motion.b_from_a.rotation.toRotationMatrix() +
                                motion.b_from_a.translation * motion.normal.transpose();
      EXPECT_LT(Difference(H, truth), 1e-7);
      const Eigen::Vector3d t = testing::TranslationOf(SceneKind::kPlane) / kDistance;
      right += AngularDistance(motion.b_from_a.rotation, scene.b_from_a.rotation) < 1e-6 &&
                       (motion.b_from_a.translation - t).norm() < 1e-6 &&
                       (motion.normal - kNormal).norm() < 1e-6
                   ? 1
                   : 0;
    }
    EXPECT_EQ(right, 1);
  }
}

TEST(MotionsFromHomography, OfATurnIsTheTurn) {
  const Eigen::Quaterniond turn = ExpSo3({0.1, -0.2, 0.05});
  const auto motions = MotionsFromHomography(-2 * turn.toRotationMatrix());
  ASSERT_EQ(motions.size(), 1U);
  EXPECT_LT(AngularDistance(motions[0].b_from_a.rotation, turn), 1e-9);
  EXPECT_EQ(motions[0].b_from_a.translation.norm(), 0);
  EXPECT_TRUE(MotionsFromHomography(Eigen::Matrix3d::Zero()).empty());
}

}  // namespace homography_test
}  // namespace plumbline
