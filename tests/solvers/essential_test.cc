// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/essential.h"

#include "plumbline/geometry/epipolar.h"

#include "tests/solvers/two_view_scene.h"
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::AngleBetween;
using testing::MakeTwoViewScene;
using testing::SceneKind;
using testing::TwoViewScene;

// Of matrices of norm 1, up to their sign.
double Difference(const Eigen::Matrix3d& E, const Eigen::Matrix3d& F) {
  return std::min((E - F).norm(), (E + F).norm());
}

std::span<const RayMatch, 5> FirstFive(const TwoViewScene& scene) {
  return std::span<const RayMatch, 5>(scene.matches.data(), 5);
}

class FivePoints : public ::testing::TestWithParam<SceneKind> {};

// Where two solutions fall together, as often on planes, they are known to half the digits.
TEST_P(FivePoints, HaveTheTrueMatrixAmongTheirSolutions) {
  int exact = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const TwoViewScene scene =
        MakeTwoViewScene(seed, {.kind = GetParam(), .points = 5, .noise = 0});
    const Eigen::Matrix3d truth = EssentialMatrix(scene.b_from_a).normalized();
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3d& E : EssentialFromFivePoints(FirstFive(scene))) {
      nearest = std::min(nearest, Difference(E, truth));
    }
    EXPECT_LT(nearest, 0.01) << seed;
    exact += nearest < 1e-5 ? 1 : 0;
  }
  EXPECT_GE(exact, 92);
}

TEST_P(FivePoints, SolutionsAreEssentialMatricesOfTheMatches) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(seed, {.kind = GetParam(), .points = 5});
    const auto solutions = EssentialFromFivePoints(FirstFive(scene));
    EXPECT_LE(solutions.size(), 10U);
    for (const Eigen::Matrix3d& E : solutions) {
      EXPECT_NEAR(E.norm(), 1, 1e-12);
      EXPECT_NEAR(E.determinant(), 0, 1e-6);
      const Eigen::Matrix3d square = E * E.transpose();
      EXPECT_LT((square * E - 0.5 * square.trace() * E).norm(), 1e-6);
      for (const RayMatch& m : scene.matches) {
        EXPECT_NEAR(m.b.homogeneous().dot(E * m.a.homogeneous()), 0, 1e-9);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes,
                         FivePoints,
                         ::testing::Values(SceneKind::kGeneral,
                                           SceneKind::kPlane,
                                           SceneKind::kForward,
                                           SceneKind::kLowParallax));

TEST(EssentialFromFivePoints, RepeatedPointsGiveNothing) {
  TwoViewScene scene = MakeTwoViewScene(1, {.points = 5, .noise = 0});
  scene.matches[4] = scene.matches[0];
  EXPECT_TRUE(EssentialFromFivePoints(FirstFive(scene)).empty());
}

TEST(EssentialFromEightPoints, ExactMatchesGiveTheTrueMatrix) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(seed, {.points = 12, .noise = 0});
    const auto E = EssentialFromEightPoints(scene.matches);
    ASSERT_TRUE(E);
    EXPECT_LT(Difference(*E, EssentialMatrix(scene.b_from_a).normalized()), 1e-7);
  }
}

TEST(FundamentalFromEightPoints, ExactMatchesGiveTheTrueMatrixAndNoisyOnesRankTwo) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(seed, {.points = 12, .noise = 0});
    const auto F = FundamentalFromEightPoints(scene.matches);
    ASSERT_TRUE(F);
    EXPECT_LT(Difference(*F, EssentialMatrix(scene.b_from_a).normalized()), 1e-6);
    const auto noisy = FundamentalFromEightPoints(MakeTwoViewScene(seed, {.points = 12}).matches);
    ASSERT_TRUE(noisy);
    EXPECT_LT(std::abs(noisy->determinant()), 1e-12);
    const Eigen::Vector3d singular = noisy->jacobiSvd().singularValues();
    EXPECT_GT(singular(0), 1.01 * singular(1)) << "not an essential matrix";
  }
}

TEST(EssentialFromEightPoints, FailsOnAPlaneAndWithFewer) {
  const TwoViewScene plane =
      MakeTwoViewScene(1, {.kind = SceneKind::kPlane, .points = 30, .noise = 0});
  EXPECT_FALSE(EssentialFromEightPoints(plane.matches));
  const TwoViewScene scene = MakeTwoViewScene(1, {.points = 7, .noise = 0});
  EXPECT_FALSE(EssentialFromEightPoints(scene.matches));
}

TEST(PosesFromEssential, AreTheFourWithThatMatrix) {
  const TwoViewScene scene = MakeTwoViewScene(2, {.points = 5});
  const Eigen::Matrix3d truth = EssentialMatrix(scene.b_from_a).normalized();
  int right = 0;
  for (const Rigid3& pose : PosesFromEssential(-3 * truth)) {
    EXPECT_NEAR(pose.translation.norm(), 1, 1e-12);
    EXPECT_LT(Difference(EssentialMatrix(pose).normalized(), truth), 1e-12);
    right += AngularDistance(pose.rotation, scene.b_from_a.rotation) < 1e-7 &&
                     AngleBetween(pose.translation, scene.b_from_a.translation) < 1e-7
                 ? 1
                 : 0;
  }
  EXPECT_EQ(right, 1);
}

}  // namespace
}  // namespace plumbline
