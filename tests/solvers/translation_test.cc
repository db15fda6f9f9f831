// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/translation.h"

#include "tests/solvers/two_view_scene.h"
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::AngleBetween;
using testing::MakeTwoViewScene;
using testing::TwoViewScene;

TEST(Translation, OfTwoExactPointsIsTrueUpToItsSign) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(seed, {.points = 2, .noise = 0});
    const auto t = TranslationFromTwoPoints(scene.b_from_a.rotation,
                                            std::span<const RayMatch, 2>(scene.matches.data(), 2));
    ASSERT_TRUE(t);
    const double angle = AngleBetween(*t, scene.b_from_a.translation);
    EXPECT_LT(std::min(angle, std::numbers::pi - angle), 1e-6);
  }
}

TEST(Translation, OfOnePointTwiceIsNone) {
  const TwoViewScene scene = MakeTwoViewScene(1, {.points = 1, .noise = 0});
  const std::array<RayMatch, 2> twice{scene.matches[0], scene.matches[0]};
  EXPECT_FALSE(TranslationFromTwoPoints(scene.b_from_a.rotation, twice));
  EXPECT_FALSE(TranslationFromPoints(scene.b_from_a.rotation, twice, Eigen::Vector3d::UnitX()));
}

TEST(Translation, WithoutAnyMotionIsNone) {
  const std::array<RayMatch, 2> still{RayMatch{{0.1, 0.2}, {0.1, 0.2}},
                                      RayMatch{{0.3, 0.2}, {0.3, 0.2}}};
  EXPECT_FALSE(TranslationFromTwoPoints(Eigen::Quaterniond::Identity(), still));
}

TEST(Translation, OfManyPointsAveragesTheNoiseAndKeepsTheSideOfTheStart) {
  const TwoViewScene scene = MakeTwoViewScene(1, {.points = 300});
  const Eigen::Vector3d truth = scene.b_from_a.translation;
  for (const double side : {1.0, -1.0}) {
    const auto t = TranslationFromPoints(
        scene.b_from_a.rotation, scene.matches, side * Eigen::Vector3d(1, 0, 0));
    ASSERT_TRUE(t);
    EXPECT_LT(AngleBetween(*t, side * truth), 1.0 * kDegree);
  }
}

}  // namespace
}  // namespace plumbline
