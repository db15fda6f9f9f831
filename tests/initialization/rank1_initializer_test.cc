// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/rank1_initializer.h"

#include "tests/initialization/track_scene.h"
#include "tests/support/synthetic_world.h"
#include <optional>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::DirectionErrorDeg;
using testing::RotationErrorDeg;

struct StartedRun {
  SyntheticWorld world = MakeSyntheticWorld(600, 80);
  std::vector<InitializationStatus> waits;
  std::optional<InitialMap> map;
};

template <class Pose>
StartedRun Start(const Pose& pose_of, int frames, double noise = 0.5) {
  StartedRun run;
  Rng rng(11, "rank1_initializer");
  Rank1Initializer initializer(run.world.Imaging(), {.matching = InitialMatching::kDescriptors}, 1);
  for (int i = 0; i < frames && !run.map; ++i) {
    const SyntheticFrame frame =
        Sense(run.world, pose_of(i), {.depth = false, .noise = noise}, rng);
    auto result = initializer.Add({FrameId{i}, i * 50'000'000, frame.indexed, nullptr});
    EXPECT_EQ(result.map.has_value(), result.wait == InitializationStatus::kNone);
    run.waits.push_back(result.wait);
    run.map = std::move(result.map);
  }
  return run;
}

TEST(Rank1Initializer, StartsAMapAsSoonAsItKnowsIt) {
  const StartedRun run = Start(PoseOnPath, 40);
  ASSERT_TRUE(run.map);
  EXPECT_EQ(run.waits[0], InitializationStatus::kTooFewFrames);
  EXPECT_LT(run.waits.size(), 20U);
  ASSERT_EQ(run.map->views.size(), 4U);
  const InitialView& newest = run.map->views.back();
  const Rigid3 truth = PoseOnPath(static_cast<int>(newest.frame.id.value)) *
                       Inverse(PoseOnPath(static_cast<int>(run.map->views.front().frame.id.value)));
  EXPECT_LT(RotationErrorDeg(newest.cam_from_world, truth), 0.3);
  EXPECT_LT(DirectionErrorDeg(newest.cam_from_world, truth), 3);
  EXPECT_GT(run.map->points.size(), 100U);
  EXPECT_GT(run.map->lines.size(), 5U);
  EXPECT_NEAR(MedianDepth(*run.map), 1, 1e-9);
}

TEST(Rank1Initializer, WaitsWhileTheCameraTurns) {
  const auto turn = [](int i) { return Rigid3{ExpSo3({0, 0.01 * i, 0}), {0, 0, 0}}; };
  const StartedRun run = Start(turn, 25);
  EXPECT_FALSE(run.map);
}

TEST(Rank1Initializer, RepeatsItself) {
  const StartedRun a = Start(PoseOnPath, 40);
  const StartedRun b = Start(PoseOnPath, 40);
  ASSERT_TRUE(a.map && b.map);
  ASSERT_EQ(a.map->points.size(), b.map->points.size());
  for (std::size_t i = 0; i < a.map->points.size(); ++i) {
    EXPECT_EQ(a.map->points[i].position, b.map->points[i].position);
  }
}

TEST(Rank1Initializer, AsksForFeatures) {
  const SyntheticWorld world = MakeSyntheticWorld(20, 0);
  Rng rng(1);
  const SyntheticFrame frame = Sense(world, {}, {.depth = false}, rng);
  Rank1Initializer initializer(world.Imaging(), {.matching = InitialMatching::kDescriptors}, 1);
  const auto result = initializer.Add({FrameId{0}, 0, frame.indexed, nullptr});
  EXPECT_EQ(result.wait, InitializationStatus::kTooFewFeatures);
}

TEST(Rank1Initializer, ForgetsWhenReset) {
  const SyntheticWorld world = MakeSyntheticWorld(600, 0);
  Rng rng(2);
  Rank1Initializer initializer(world.Imaging(), {.matching = InitialMatching::kDescriptors}, 1);
  const SyntheticFrame frame = Sense(world, {}, {.depth = false}, rng);
  initializer.Add({FrameId{0}, 0, frame.indexed, nullptr});
  EXPECT_GT(initializer.Add({FrameId{1}, 1, frame.indexed, nullptr}).matches, 100);
  initializer.Reset();
  EXPECT_EQ(initializer.Add({FrameId{2}, 2, frame.indexed, nullptr}).matches, 0);
}

}  // namespace
}  // namespace plumbline
