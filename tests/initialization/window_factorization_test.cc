// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_factorization.h"

#include "tests/initialization/window_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeWindowScene;
using testing::RotationErrorDeg;
using testing::WindowScene;

Rigid3 OfUnitLength(Rigid3 pose) {
  pose.translation.normalize();
  return pose;
}

// All poses and points up to one scale.
void ExpectTruth(const WindowScene& scene, const WindowSolution& solution, double tolerance) {
  const double scale = solution.cam_from_reference.back().translation.norm() /
                       scene.truth.cam_from_reference.back().translation.norm();
  for (std::size_t i = 0; i < scene.truth.cam_from_reference.size(); ++i) {
    const Rigid3& truth = scene.truth.cam_from_reference[i];
    EXPECT_LT(RotationErrorDeg(solution.cam_from_reference[i], truth), tolerance);
    EXPECT_LT((solution.cam_from_reference[i].translation / scale - truth.translation).norm(),
              tolerance);
  }
  for (std::size_t k = 0; k < scene.truth.points.size(); ++k) {
    if (!solution.is_known[k]) continue;
    EXPECT_LT((solution.points[k] / scale - scene.truth.points[k]).norm(), 10 * tolerance);
  }
}

TEST(FactorizeWindow, FindsAllFromThePoseOfTheNewest) {
  for (const bool plane : {false, true}) {
    const WindowScene scene = MakeWindowScene(1, CurvedMotion(4), {.plane = plane});
    const Rigid3 newest = OfUnitLength(scene.truth.cam_from_reference.back());
    const auto solution = FactorizeWindow(scene.tracks, {newest, {}}, {});
    ASSERT_TRUE(solution);
    ExpectTruth(scene, *solution, 1e-4);
  }
}

// Half of the places between are missing: the rest gives the ratios of the translations, these the
// missing places.
TEST(FactorizeWindow, InterpolatesWhatIsMissing) {
  const WindowScene scene = MakeWindowScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const Rigid3 newest = OfUnitLength(scene.truth.cam_from_reference.back());
  const auto with = FactorizeWindow(scene.tracks, {newest, {}}, {});
  ASSERT_TRUE(with);
  ExpectTruth(scene, *with, 1e-4);
  const auto without = FactorizeWindow(scene.tracks, {newest, {}}, {.interpolate = false});
  ASSERT_TRUE(without);
  const auto known = [](const WindowSolution& s) {
    return std::count(s.is_known.begin(), s.is_known.end(), true);
  };
  EXPECT_GT(known(*with), 280);
  EXPECT_LT(known(*without), 120) << "only points that all frames show";
}

TEST(FactorizeWindow, TriangulatesFromResectedPosesWhenAskedTo) {
  const WindowScene scene = MakeWindowScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const Rigid3 newest = OfUnitLength(scene.truth.cam_from_reference.back());
  const WindowFactorizationOptions plain{.factorize = false};
  const auto solution = FactorizeWindow(scene.tracks, {newest, {}}, plain);
  ASSERT_TRUE(solution);
  ExpectTruth(scene, *solution, 1e-4);
  EXPECT_EQ(std::count(solution->is_known.begin(), solution->is_known.end(), true), 300);
  // Where places are noisy, factorization moves the newest pose, and resection leaves it as it was.
  const WindowScene noisy = MakeWindowScene(2, CurvedMotion(3), {.sigma = 1e-3});
  const auto moved = [&](const WindowFactorizationOptions& options) {
    const auto found = FactorizeWindow(noisy.tracks, {newest, {}}, options);
    return (OfUnitLength(found->cam_from_reference.back()).translation - newest.translation).norm();
  };
  EXPECT_LT(moved(plain), 1e-15);
  EXPECT_GT(moved({}), 1e-5);
}

TEST(FactorizeWindow, BeginsFromPointsOfAnEarlierWindow) {
  const WindowScene scene = MakeWindowScene(3, CurvedMotion(3));
  WindowHypothesis hypothesis;  // the pose no better than a guess
  hypothesis.newest_from_reference.translation = {-0.3, 0, 0};
  for (const Eigen::Vector3d& point : scene.truth.points) {
    hypothesis.inverse_distances.push_back(1 / point.norm());
  }
  const auto solution = FactorizeWindow(scene.tracks, hypothesis, {});
  ASSERT_TRUE(solution);
  ExpectTruth(scene, *solution, 1e-4);
}

TEST(FactorizeWindow, RefusesAPoseWithPointsBehind) {
  const WindowScene scene = MakeWindowScene(4, CurvedMotion(3));
  Rigid3 newest = scene.truth.cam_from_reference.back();
  newest.translation *= -1;
  EXPECT_FALSE(FactorizeWindow(scene.tracks, {newest, {}}, {}));
}

TEST(FactorizeWindow, RefusesAFrameThatDoesNotGoWithTheOthers) {
  WindowScene scene = MakeWindowScene(5, CurvedMotion(3));
  Rng rng(5);
  for (Eigen::Vector2d& place : scene.tracks.views[1].points) place = RandomVector<2>(rng, 0.3);
  const Rigid3& newest = scene.truth.cam_from_reference.back();
  EXPECT_FALSE(FactorizeWindow(scene.tracks, {newest, {}}, {}));
}

}  // namespace
}  // namespace plumbline
