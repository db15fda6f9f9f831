// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/rotation.h"

#include "tests/solvers/two_view_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::MakeTwoViewScene;
using testing::SceneKind;
using testing::TwoViewScene;

TEST(FitRotation, FindsATurnAmongWrongMatches) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TwoViewScene scene =
        MakeTwoViewScene(seed, {.kind = SceneKind::kTurnOnly, .points = 300, .outliers = 0.3});
    Rng rng(seed, "rotation");
    const RotationFit fit = FitRotation(scene.matches, rng);
    EXPECT_LT(AngularDistance(fit.b_from_a, scene.b_from_a.rotation), 0.1 * kDegree);
    EXPECT_GT(fit.inliers, 170);
    EXPECT_LT(fit.median_residual, 0.4 * kDegree);  // of 2.8 px, with the outliers
  }
}

TEST(FitRotation, LeavesTheParallaxOver) {
  const TwoViewScene scene = MakeTwoViewScene(1, {.points = 300});
  Rng rng(1, "rotation");
  const RotationFit fit = FitRotation(scene.matches, rng);
  EXPECT_LT(fit.inliers, 150);
  EXPECT_GT(fit.median_residual, 0.5 * kDegree);
  const RotationFit none = FitRotation({}, rng);
  EXPECT_EQ(none.inliers, 0);
}

TEST(FitRotation, SameSeedSameBytes) {
  const TwoViewScene scene = MakeTwoViewScene(1, {.outliers = 0.4});
  Rng first(7, "rotation");
  Rng second(7, "rotation");
  EXPECT_EQ(FitRotation(scene.matches, first).b_from_a.coeffs(),
            FitRotation(scene.matches, second).b_from_a.coeffs());
}

// A point 4 m ahead seen from 0.4 m to the side.
TEST(MedianParallax, IsTheAngleAtThePoint) {
  const Rigid3 pose{ExpSo3({0, 0.1, 0}), ExpSo3({0, 0.1, 0}) * Eigen::Vector3d(-0.4, 0, 0)};
  const Eigen::Vector3d in_b = pose * Eigen::Vector3d(0, 0, 4);
  const std::vector<RayMatch> matches{{{0, 0}, in_b.hnormalized()}};
  EXPECT_NEAR(MedianParallax(matches, pose.rotation), std::atan(0.1), 1e-12);
  EXPECT_EQ(MedianParallax({}, pose.rotation), 0);
}

}  // namespace
}  // namespace plumbline
