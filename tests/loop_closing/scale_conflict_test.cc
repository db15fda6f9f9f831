// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/scale_conflict.h"

#include "tests/loop_closing/loop_scene.h"
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::LoopScene;
using testing::LoopSceneOptions;
using testing::MakeLoopScene;

// A small circle, gone round in 24 keyframes and a bit further; by keyframe the unit of the map.
LoopScene OneRound(const std::function<double(int)>& unit, int alike_sectors = 1) {
  LoopSceneOptions options;
  options.sensor.depth = false;
  options.keyframes_per_round = 24;
  options.keyframes = 28;
  options.alike_sectors = alike_sectors;
  options.drift = [unit](int keyframe) {
    Similarity3 drift;
    drift.scale = unit(keyframe);
    return drift;
  };
  return MakeLoopScene(options);
}

// From keyframe to keyframe, so that a round makes `growth` of it.
std::function<double(int)> Gradually(double growth) {
  return [growth](int keyframe) { return std::pow(growth, keyframe / 24.0); };
}

// Once, halfway round.
std::function<double(int)> AtOnce(double growth) {
  return [growth](int keyframe) { return keyframe < 14 ? 1 : growth; };
}

std::optional<ScaleConflict> Find(const LoopScene& scene) {
  const std::vector<KeyFrameId> candidates{KeyFrameId{12}, KeyFrameId{3}};
  return FindScaleConflict(scene.map, scene.Newest(), candidates, scene.Imaging(), {});
}

TEST(ScaleConflict, IsFoundWhereTheUnitRunsAway) {
  const auto expect_found = [](const LoopScene& scene, double growth) {
    const auto conflict = Find(scene);
    ASSERT_TRUE(conflict) << growth;
    EXPECT_EQ(conflict->older, KeyFrameId{3});
    const double expected = std::abs(std::log(growth));
    EXPECT_NEAR(std::abs(std::log(conflict->scale)), expected, 0.1 * expected) << growth;
  };
  for (const double growth : {4.0, 0.25}) expect_found(OneRound(Gradually(growth)), growth);
  for (const double growth : {3.0, 150.0}) expect_found(OneRound(AtOnce(growth)), growth);
}

TEST(ScaleConflict, IsNoneWhereItDriftsAsItDoes) {
  for (const double growth : {1.0, 1.1, 0.8, 1.6})
    EXPECT_FALSE(Find(OneRound(Gradually(growth)))) << growth;
}

// Rooms that look alike have one size.
TEST(ScaleConflict, IsNoneBetweenThingsThatLookAlike) {
  EXPECT_FALSE(Find(OneRound(Gradually(1), 4)));
}

}  // namespace
}  // namespace plumbline
