// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/track_factorization.h"

#include "tests/initialization/track_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeTrackScene;
using testing::RotationErrorDeg;
using testing::TrackScene;

Rigid3 OfUnitLength(Rigid3 pose) {
  pose.translation.normalize();
  return pose;
}

// All poses and points up to one scale.
void ExpectTruth(const TrackScene& scene, const Reconstruction& solution, double tolerance) {
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

TEST(FactorizeTracks, FindsAllFromThePoseOfTheNewest) {
  for (const bool plane : {false, true}) {
    const TrackScene scene = MakeTrackScene(1, CurvedMotion(4), {.plane = plane});
    const Rigid3 newest = OfUnitLength(scene.truth.cam_from_reference.back());
    const auto solution = FactorizeTracks(scene.tracks, {newest, {}}, {});
    ASSERT_TRUE(solution);
    ExpectTruth(scene, *solution, 1e-4);
  }
}

// Half of the places between are missing: the rest gives the ratios of the translations, these the
// missing places.
TEST(FactorizeTracks, InterpolatesWhatIsMissing) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const Rigid3 newest = OfUnitLength(scene.truth.cam_from_reference.back());
  const auto with = FactorizeTracks(scene.tracks, {newest, {}}, {});
  ASSERT_TRUE(with);
  ExpectTruth(scene, *with, 1e-4);
  const auto without = FactorizeTracks(scene.tracks, {newest, {}}, {.interpolate = false});
  ASSERT_TRUE(without);
  const auto known = [](const Reconstruction& s) {
    return std::count(s.is_known.begin(), s.is_known.end(), true);
  };
  EXPECT_GT(known(*with), 280);
  EXPECT_LT(known(*without), 120) << "only points that all frames show";
}

TEST(FactorizeTracks, TriangulatesFromResectedPosesWhenAskedTo) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const Rigid3 newest = OfUnitLength(scene.truth.cam_from_reference.back());
  const FactorizationOptions plain{.factorize = false};
  const auto solution = FactorizeTracks(scene.tracks, {newest, {}}, plain);
  ASSERT_TRUE(solution);
  ExpectTruth(scene, *solution, 1e-4);
  EXPECT_EQ(std::count(solution->is_known.begin(), solution->is_known.end(), true), 300);
  // Where places are noisy, factorization moves the newest pose, and resection leaves it as it was.
  const TrackScene noisy = MakeTrackScene(2, CurvedMotion(3), {.sigma = 1e-3});
  const auto moved = [&](const FactorizationOptions& options) {
    const auto found = FactorizeTracks(noisy.tracks, {newest, {}}, options);
    return (OfUnitLength(found->cam_from_reference.back()).translation - newest.translation).norm();
  };
  EXPECT_LT(moved(plain), 1e-15);
  EXPECT_GT(moved({}), 1e-5);
}

TEST(FactorizeTracks, BeginsFromPointsOfAnEarlierWindow) {
  const TrackScene scene = MakeTrackScene(3, CurvedMotion(3));
  MotionHypothesis hypothesis;  // the pose no better than a guess
  hypothesis.newest_from_reference.translation = {-0.3, 0, 0};
  for (const Eigen::Vector3d& point : scene.truth.points) {
    hypothesis.inverse_distances.push_back(1 / point.norm());
  }
  const auto solution = FactorizeTracks(scene.tracks, hypothesis, {});
  ASSERT_TRUE(solution);
  ExpectTruth(scene, *solution, 1e-4);
}

TEST(FactorizeTracks, RefusesAPoseWithPointsBehind) {
  const TrackScene scene = MakeTrackScene(4, CurvedMotion(3));
  Rigid3 newest = scene.truth.cam_from_reference.back();
  newest.translation *= -1;
  EXPECT_FALSE(FactorizeTracks(scene.tracks, {newest, {}}, {}));
}

TEST(FactorizeTracks, RefusesAFrameThatDoesNotGoWithTheOthers) {
  TrackScene scene = MakeTrackScene(5, CurvedMotion(3));
  Rng rng(5);
  for (Eigen::Vector2d& place : scene.tracks.views[1].points) place = RandomVector<2>(rng, 0.3);
  const Rigid3& newest = scene.truth.cam_from_reference.back();
  EXPECT_FALSE(FactorizeTracks(scene.tracks, {newest, {}}, {}));
}

}  // namespace
}  // namespace plumbline
