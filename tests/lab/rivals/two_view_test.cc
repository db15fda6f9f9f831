// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/two_view.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/epipolar.h"

#include "tests/initialization/blob_images.h"
#include "tests/initialization/track_scene.h"
#include "tests/solvers/two_view_scene.h"
#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <optional>
#include <span>

#include <gtest/gtest.h>

namespace plumbline {
namespace two_view_test {

using testing::AngleBetween;
using testing::Blobs;
using testing::DirectionErrorDeg;
using testing::FrameAt;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::SceneKind;
using testing::TwoViewScene;

InitializationFrame FrameOf(int index, const SyntheticFrame& sensed) {
  return {FrameId{index}, index * 50'000'000, sensed.indexed, nullptr};
}

TEST(TwoViewScores, OfExactMatchesAreTheMost) {
  const TwoViewScene plane =
      MakeTwoViewScene(1, {.kind = SceneKind::kPlane, .points = 50, .noise = 0});
  const Eigen::Vector3d over_distance =
      testing::TranslationOf(SceneKind::kPlane) / 4;  // the plane is (0.3, -0.2, 1) X = 4
  const Eigen::Matrix3d H =
      plane.b_from_a.rotation.toRotationMatrix() + over_distance * Eigen::RowVector3d(0.3, -0.2, 1);
  EXPECT_NEAR(TransferScore(H, plane.matches), 2 * 50 * 5.991, 1e-6);
  EXPECT_NEAR(EpipolarScore(EssentialMatrix(plane.b_from_a), plane.matches), 2 * 50 * 5.991, 1e-6);
  EXPECT_LT(TransferScore(Eigen::Matrix3d::Identity(), plane.matches), 200);
}

constexpr double kPixel = 1.0 / 500;

TEST(TwoViewScores, CountWhatIsWithinTheLimit) {
  const double pixel = kPixel;
  // Motion along x: epipolar lines are rows.
  const Eigen::Matrix3d E = EssentialMatrix({Eigen::Quaterniond::Identity(), {1, 0, 0}});
  const auto score = [&](double rows) {
    const RayMatch m{{0.1, 0.2}, {0.05, 0.2 + rows * pixel}, pixel, pixel};
    return EpipolarScore(E, std::span(&m, 1));
  };
  EXPECT_NEAR(score(1), 2 * (5.991 - 1), 1e-3);
  EXPECT_NEAR(score(1.95), 2 * (5.991 - 1.95 * 1.95), 1e-3);
  EXPECT_EQ(score(1.97), 0);
  const auto transfer = [&](double px) {
    const RayMatch m{{0.1, 0.2}, {0.1 + px * pixel, 0.2}, pixel, pixel};
    return TransferScore(Eigen::Matrix3d::Identity(), std::span(&m, 1));
  };
  EXPECT_NEAR(transfer(2.4), 2 * (5.991 - 2.4 * 2.4), 1e-3);
  EXPECT_EQ(transfer(2.46), 0);
}

// Models are those of eight matches, so that poses are coarse and some frames are left for the next
// one.
TEST(SolveTwoViews, ChoosesTheModelOfTheScene) {
  int started_in_space = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Rng rng(seed);
    const TwoViewScene space = MakeTwoViewScene(seed, {.outliers = 0.1, .sigma = 0.5 / 500});
    const TwoViewSolution in_space = SolveTwoViews(space.matches, kPixel, rng);
    EXPECT_EQ(in_space.model, TwoViewModel::kFundamental);
    EXPECT_LT(AngularDistance(in_space.b_from_a.rotation, space.b_from_a.rotation), 1.5 * kDegree);
    EXPECT_LT(AngleBetween(in_space.b_from_a.translation, space.b_from_a.translation),
              12 * kDegree);
    EXPECT_EQ(in_space.is_good.size(), space.matches.size());
    started_in_space += in_space.wait == InitializationStatus::kNone;
    const TwoViewScene plane =
        MakeTwoViewScene(seed, {.kind = SceneKind::kPlane, .outliers = 0.1, .sigma = 0.5 / 500});
    const TwoViewSolution on_plane = SolveTwoViews(plane.matches, kPixel, rng);
    EXPECT_EQ(on_plane.model, TwoViewModel::kHomography);
    EXPECT_LT(AngleBetween(on_plane.b_from_a.translation, plane.b_from_a.translation),
              15 * kDegree);
  }
  EXPECT_GE(started_in_space, 7);
}

TEST(SolveTwoViews, FindsExactMotions) {
  for (const SceneKind kind : {SceneKind::kGeneral, SceneKind::kPlane}) {
    Rng rng(3);
    const TwoViewScene scene = MakeTwoViewScene(4, {.kind = kind, .noise = 0});
    const TwoViewSolution found = SolveTwoViews(scene.matches, kPixel, rng);
    EXPECT_EQ(found.wait, InitializationStatus::kNone);
    EXPECT_EQ(found.model == TwoViewModel::kHomography, kind == SceneKind::kPlane);
    EXPECT_LT(AngularDistance(found.b_from_a.rotation, scene.b_from_a.rotation), 1e-6);
    EXPECT_LT(AngleBetween(found.b_from_a.translation, scene.b_from_a.translation), 1e-5);
  }
}

TEST(SolveTwoViews, WaitsWhereTheFramesDoNotDecide) {
  Rng rng(1);
  const auto wait = [&](SceneKind kind, int points) {
    const TwoViewScene scene =
        MakeTwoViewScene(2, {.kind = kind, .points = points, .sigma = 0.5 / 500});
    return SolveTwoViews(scene.matches, kPixel, rng).wait;
  };
  EXPECT_EQ(wait(SceneKind::kGeneral, 99), InitializationStatus::kTooFewMatches);
  EXPECT_EQ(wait(SceneKind::kTwofoldPlane, 300), InitializationStatus::kAmbiguous);
  EXPECT_EQ(wait(SceneKind::kTurnOnly, 300), InitializationStatus::kTooLittleParallax);
}

TEST(TwoViewInitializer, StartsAMapOnceThereIsParallax) {
  const SyntheticWorld world = MakeSyntheticWorld(600, 60);
  TwoViewInitializer initializer(world.camera, 1);
  Rng rng(2);
  InitializationResult result;
  int last = 0;
  for (int i = 0; i < 30 && !result.map; ++i) {
    last = i;
    const SyntheticFrame sensed = Sense(world, PoseOnPath(i), {.depth = false, .noise = 0.5}, rng);
    result = initializer.Add(FrameOf(i, sensed));
    EXPECT_EQ(result.map.has_value(), result.wait == InitializationStatus::kNone);
  }
  ASSERT_TRUE(result.map);
  EXPECT_GT(last, 1);
  EXPECT_GE(result.parallax_deg, 1);
  const InitialMap& map = *result.map;
  ASSERT_EQ(map.views.size(), 2U);
  EXPECT_EQ(map.views.front().frame.id, FrameId{0});
  EXPECT_EQ(map.views.back().frame.id, FrameId{last});
  EXPECT_EQ(map.views.front().cam_from_world.translation.norm(), 0);
  EXPECT_GT(map.points.size(), 100U);
  EXPECT_GT(map.lines.size(), 3U);
  const Rigid3 truth = PoseOnPath(last);
  const Rigid3& pose = map.views.back().cam_from_world;
  EXPECT_LT(AngularDistance(pose.rotation, truth.rotation), 0.5 * kDegree);
  EXPECT_LT(AngleBetween(pose.translation, truth.translation), 8 * kDegree);
}

TEST(TwoViewInitializer, ReplacesAReferenceThatIsOutOfSight) {
  const SyntheticWorld world = MakeSyntheticWorld(600, 0);
  TwoViewInitializer initializer(world.camera, 1);
  Rng rng(2);
  const SensorModel sensor{.depth = false};
  const auto add = [&](int index, const Rigid3& pose) {
    return initializer.Add(FrameOf(index, Sense(world, pose, sensor, rng)));
  };
  EXPECT_EQ(add(0, {}).wait, InitializationStatus::kTooFewFrames);
  const Rigid3 aside{ExpSo3({0, 0.6, 0}), {0, 0, 0}};
  EXPECT_EQ(add(1, aside).wait, InitializationStatus::kTooFewMatches);
  EXPECT_EQ(add(2, aside).wait, InitializationStatus::kTooLittleParallax);
  initializer.Reset();
  EXPECT_EQ(add(3, aside).wait, InitializationStatus::kTooFewFrames);
  const SyntheticFrame nothing{IndexFeatures(world.camera, {}), {}, {}};
  EXPECT_EQ(initializer.Add(FrameOf(4, nothing)).wait, InitializationStatus::kTooFewFeatures);
}

TEST(TwoViewImagesInitializer, StartsFromPlacesOnTheImages) {
  const Blobs blobs;
  Rng rng(1);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  for (int i = 0; i < 20; ++i) {
    const auto result = initializer.Add(FrameAt(blobs, PoseOnPath(i), i, rng));
    EXPECT_EQ(result.map.has_value(), result.wait == InitializationStatus::kNone);
    if (!result.map) continue;
    EXPECT_GE(result.matches, 100);
    EXPECT_GE(result.parallax_deg, 1);
    ASSERT_EQ(result.map->views.size(), 2U);
    EXPECT_EQ(result.map->views.front().frame.id.value, 0);
    EXPECT_LT(RotationErrorDeg(result.map->views.back().cam_from_world, PoseOnPath(i)), 0.5);
    EXPECT_LT(DirectionErrorDeg(result.map->views.back().cam_from_world, PoseOnPath(i)), 5);
    for (const InitialPoint& point : result.map->points) {
      EXPECT_TRUE(point.observations.back().px) << "where the image shows it";
    }
    return;
  }
  FAIL() << "no map";
}

TEST(TwoViewImagesInitializer, KeepsTheReferenceWhileTheCameraStands) {
  const Blobs blobs;
  Rng rng(1);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  constexpr int kStanding = 4;
  std::optional<InitialMap> map;
  for (int i = 0; i < kStanding + 20 && !map; ++i) {
    const Rigid3 pose = PoseOnPath(std::max(0, i - kStanding));
    map = initializer.Add(FrameAt(blobs, pose, i, rng)).map;
    EXPECT_FALSE(map && i <= kStanding);
  }
  ASSERT_TRUE(map);
  EXPECT_EQ(map->views.front().frame.id.value, 0);
  initializer.Reset();
  EXPECT_EQ(initializer.Add(FrameAt(blobs, {}, 40, rng)).wait, InitializationStatus::kTooFewFrames);
}

// The reference moves to the frame halfway when matches have died out, so that there are more
// again.
TEST(TwoViewImagesInitializer, MovesTheReferenceWhenMatchesDieOut) {
  const Blobs blobs;
  Rng rng(3);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  InitializationResult before;
  bool moved = false;
  for (int i = 0; i < 30 && !moved; ++i) {
    const Rigid3 turned{ExpSo3({0, 0.06 * i, 0}), {0, 0, 0}};
    const auto result = initializer.Add(FrameAt(blobs, turned, i, rng));
    EXPECT_FALSE(result.map);
    moved = before.wait == InitializationStatus::kTooFewMatches && before.matches > 0 &&
            result.matches > 1.5 * before.matches;
    before = result;
  }
  EXPECT_TRUE(moved);
}

TEST(TwoViewImagesInitializer, AsksForFeaturesAndImages) {
  const Blobs blobs;
  Rng rng(4);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  InitializationFrame frame = FrameAt(blobs, {}, 0, rng);
  const SyntheticFrame nothing{IndexFeatures(blobs.world.camera, {}), {}, {}};
  EXPECT_EQ(initializer.Add({FrameId{0}, 0, nothing.indexed, frame.image}).wait,
            InitializationStatus::kTooFewFeatures);
  frame.image = nullptr;
  EXPECT_THROW(initializer.Add(frame), BugError);
}

}  // namespace two_view_test
}  // namespace plumbline
