// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/loop_closer.h"

#include "tests/loop_closing/loop_scene.h"
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace loop_closer_test {

using testing::CountOf;
using testing::LargestShift;
using testing::LoopScene;
using testing::LoopSceneOptions;
using testing::MakeLoopScene;
using testing::WorstPlace;

LoopScene Drifted() {
  LoopSceneOptions options;
  options.drift = testing::GrowingDrift;
  return MakeLoopScene(options);
}

constexpr KeyFrameId kQuery{45};

TEST(LoopCloser, ClosesALoopAndTellsOfIt) {
  LoopScene scene = Drifted();
  const double before = WorstPlace(scene);
  LoopCloser closer(scene.Imaging(), {});
  const std::vector<KeyFrameId> candidates{KeyFrameId{20}, KeyFrameId{5}};
  const auto closure = closer.Try(scene.map, kQuery, candidates);
  ASSERT_TRUE(closure);
  EXPECT_GT(CountOf<edit::MergePoints>(closure->edit), 100);
  ASSERT_EQ(closer.loops().size(), 1U);
  EXPECT_EQ(closer.loops()[0].query, kQuery);
  EXPECT_EQ(closer.loops()[0].candidate, KeyFrameId{5});
  ASSERT_EQ(closer.attempts().size(), 2U);
  EXPECT_TRUE(closer.attempts()[0].unverified);
  const Map drifted = scene.map;
  scene.map.Apply(closure->edit);
  scene.map.CheckInvariants();
  EXPECT_GT(LargestShift(drifted, scene.map), 0.1);
  EXPECT_LT(WorstPlace(scene), 0.3 * before);
}

// Both edits give each keyframe of the map the same pose, as it is stored.
void ExpectSamePoses(const Map& map, const MapEdit& expected, const MapEdit& edit) {
  Map first = map;
  first.Apply(expected);
  Map second = map;
  second.Apply(edit);
  for (const auto& [id, keyframe] : first.keyframes()) {
    const Rigid3& pose = second.Find(id)->frame.cam_from_world;
    EXPECT_EQ(keyframe.frame.cam_from_world.translation, pose.translation);
    EXPECT_EQ(keyframe.frame.cam_from_world.rotation, pose.rotation);
  }
}

TEST(LoopCloser, PassesOverWhatIsCovisibleOrGone) {
  const LoopScene scene = Drifted();
  LoopCloser closer(scene.Imaging(), {});
  const std::vector<KeyFrameId> candidates{KeyFrameId{44}, KeyFrameId{43}, kQuery, KeyFrameId{99}};
  EXPECT_FALSE(closer.Try(scene.map, kQuery, candidates));
  EXPECT_TRUE(closer.attempts().empty());
}

// Rooms that look alike, a quarter of the circle apart: the images agree, odometry does not.
TEST(LoopCloser, TellsIdenticalRoomsApartByDrift) {
  LoopSceneOptions options;
  options.alike_sectors = 4;
  options.drift = testing::GrowingDrift;
  const LoopScene scene = MakeLoopScene(options);
  LoopCloser closer(scene.Imaging(), {});
  const std::vector<KeyFrameId> alike{KeyFrameId{15}, KeyFrameId{25}};
  EXPECT_FALSE(closer.Try(scene.map, kQuery, alike));
  for (const LoopAttempt& attempt : closer.attempts()) {
    EXPECT_TRUE(attempt.beyond_drift);
    EXPECT_TRUE(attempt.edge);
  }
  EXPECT_EQ(closer.attempts().size(), 2U);
  const std::vector<KeyFrameId> right{KeyFrameId{5}};
  EXPECT_TRUE(closer.Try(scene.map, kQuery, right));
}

// What a closer has counted of the map in earlier searches changes nothing.
TEST(LoopCloser, DoesWhatANewOneDoesWhenTheMapHasChanged) {
  LoopSceneOptions options;
  options.alike_sectors = 4;
  options.drift = testing::GrowingDrift;
  LoopScene scene = MakeLoopScene(options);
  LoopCloser closer(scene.Imaging(), {});
  const std::vector<KeyFrameId> alike{KeyFrameId{15}, KeyFrameId{25}};
  EXPECT_FALSE(closer.Try(scene.map, kQuery, alike));
  scene.map.Apply({edit::RemoveKeyFrame{KeyFrameId{35}}});
  LoopCloser anew(scene.Imaging(), {});
  EXPECT_FALSE(closer.Try(scene.map, kQuery, alike));
  EXPECT_FALSE(anew.Try(scene.map, kQuery, alike));
  ASSERT_EQ(closer.attempts().size(), 2U);
  ASSERT_EQ(anew.attempts().size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(closer.attempts()[i].beyond_drift);
    EXPECT_EQ(closer.attempts()[i].drift_chi2, anew.attempts()[i].drift_chi2);
  }
  const std::vector<KeyFrameId> right{KeyFrameId{5}};
  const auto closure = closer.Try(scene.map, kQuery, right);
  const auto expected = anew.Try(scene.map, kQuery, right);
  ASSERT_TRUE(closure && expected);
  ExpectSamePoses(scene.map, expected->edit, closure->edit);
}

// What sees the place from afar is right, too, but says little: a nearer view is waited for.
TEST(LoopCloser, WaitsForALoopThatIsKnownWell) {
  const LoopScene scene = Drifted();
  LoopOptions options;
  options.max_rotation_sigma_deg = 0.01;
  LoopCloser strict(scene.Imaging(), options);
  const std::vector<KeyFrameId> candidates{KeyFrameId{5}};
  EXPECT_FALSE(strict.Try(scene.map, kQuery, candidates));
  ASSERT_EQ(strict.attempts().size(), 1U);
  EXPECT_TRUE(strict.attempts()[0].edge);
  EXPECT_TRUE(strict.attempts()[0].uncertain);
  EXPECT_TRUE(strict.loops().empty());
  LoopCloser usual(scene.Imaging(), {});
  EXPECT_TRUE(usual.Try(scene.map, kQuery, candidates));
}

// A scale that drifts further than it does as a rule is believed when a second keyframe finds it.
TEST(LoopCloser, WantsTwoWitnessesWhereTheScaleDriftedFar) {
  LoopSceneOptions options;
  options.sensor.depth = false;
  options.drift = [](int i) {
    Similarity3 grown;
    grown.scale = std::exp(0.006 * i);
    return grown;
  };
  const LoopScene scene = MakeLoopScene(options);
  LoopCloser closer(scene.Imaging(), {});
  const std::vector<KeyFrameId> first{KeyFrameId{4}};
  EXPECT_FALSE(closer.Try(scene.map, KeyFrameId{44}, first));
  ASSERT_EQ(closer.attempts().size(), 1U);
  EXPECT_TRUE(closer.attempts()[0].drifted_far);
  EXPECT_TRUE(closer.attempts()[0].waits);
  // A keyframe that finds the loop twice is still a single witness.
  EXPECT_FALSE(closer.Try(scene.map, KeyFrameId{44}, first));
  const std::vector<KeyFrameId> second{KeyFrameId{5}};
  const auto closure = closer.Try(scene.map, kQuery, second);
  ASSERT_TRUE(closure);
  Map closed = scene.map;
  closed.Apply(closure->edit);
  const double scale = closed.PlaceOf(kQuery).scale / scene.map.PlaceOf(kQuery).scale;
  EXPECT_NEAR(std::log(scale), -0.006 * 40, 0.03);

  LoopOptions as_a_rule;
  as_a_rule.drift.log_scale_per_turn = 0;
  LoopCloser strict(scene.Imaging(), as_a_rule);
  EXPECT_FALSE(strict.Try(scene.map, KeyFrameId{44}, first));
  EXPECT_FALSE(strict.Try(scene.map, kQuery, second));
  EXPECT_TRUE(strict.attempts()[0].beyond_drift);
}

TEST(LoopCloser, PausesAfterAClosure) {
  LoopScene scene = Drifted();
  LoopCloser closer(scene.Imaging(), {});
  const std::vector<KeyFrameId> first{KeyFrameId{2}};
  const auto closure = closer.Try(scene.map, KeyFrameId{42}, first);
  ASSERT_TRUE(closure);
  scene.map.Apply(closure->edit);
  const std::vector<KeyFrameId> next{KeyFrameId{10}};
  EXPECT_FALSE(closer.Try(scene.map, KeyFrameId{44}, next));
  EXPECT_TRUE(closer.attempts().empty());
}

// Keyframes of each map are numbered from 0.
TEST(LoopCloser, DoesNotPauseForALoopOfAnotherMap) {
  const LoopScene scene = Drifted();
  LoopCloser closer(scene.Imaging(), {});
  const std::vector<KeyFrameId> candidates{KeyFrameId{5}};
  ASSERT_TRUE(closer.Try(scene.map, kQuery, candidates));
  // A map that does not have this keyframe.
  LoopSceneOptions options;
  options.drift = testing::GrowingDrift;
  options.keyframes = static_cast<int>(kQuery.value);
  const LoopScene other = MakeLoopScene(options);
  ASSERT_FALSE(other.map.Knows(kQuery));
  closer.Try(other.map, KeyFrameId{44}, std::vector{KeyFrameId{4}});
  EXPECT_EQ(closer.attempts().size(), 1U) << "while it pauses, it looks at none";
}

}  // namespace loop_closer_test
}  // namespace plumbline
