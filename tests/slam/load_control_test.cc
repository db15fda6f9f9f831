// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/load_control.h"

#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr Load kInTime{.wait = 0.1};
constexpr Load kLate{.wait = 1.5};
constexpr Load kDropped{.wait = 1.5, .frames_dropped = 2};

std::vector<LoadLevel> Decide(LoadControl& shedding, const Load& load, int frames) {
  std::vector<LoadLevel> decided;
  for (int i = 0; i < frames; ++i) decided.push_back(shedding.Next(load));
  return decided;
}

TEST(LoadControl, ShedsNothingInTime) {
  LoadControl shedding;
  for (const LoadLevel shed : Decide(shedding, kInTime, 100)) EXPECT_EQ(shed, LoadLevel::kNothing);
}

TEST(LoadControl, LetsSingleLateFramesPass) {
  LoadControl shedding;
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(shedding.Next(kLate), LoadLevel::kNothing);
    EXPECT_EQ(shedding.Next(kInTime), LoadLevel::kNothing);
  }
}

TEST(LoadControl, ShedsMoreInOrderWhileFramesAreLate) {
  LoadControl shedding;
  const std::vector<LoadLevel> expected = {LoadLevel::kNothing,
                                           LoadLevel::kMapping,
                                           LoadLevel::kMapping,
                                           LoadLevel::kLines,
                                           LoadLevel::kLines,
                                           LoadLevel::kPoints,
                                           LoadLevel::kPoints,
                                           LoadLevel::kPoints};
  EXPECT_EQ(Decide(shedding, kLate, 8), expected);
}

TEST(LoadControl, DoesNotWaitForASecondFrameThatIsLeftOut) {
  LoadControl shedding;
  const std::vector<LoadLevel> expected = {
      LoadLevel::kMapping, LoadLevel::kLines, LoadLevel::kPoints, LoadLevel::kPoints};
  EXPECT_EQ(Decide(shedding, kDropped, 4), expected);
}

TEST(LoadControl, EndsStepByStepWithTheLoad) {
  LoadControl shedding;
  Decide(shedding, kDropped, 5);
  const int calm = LoadControl::kCalmFrames;
  std::vector<LoadLevel> expected;
  for (const LoadLevel shed : {LoadLevel::kPoints, LoadLevel::kLines, LoadLevel::kMapping}) {
    expected.insert(expected.end(), static_cast<std::size_t>(calm), shed);
  }
  expected.erase(expected.begin());  // the first calm frames end with the change
  expected.push_back(LoadLevel::kNothing);
  EXPECT_EQ(Decide(shedding, kInTime, 3 * calm), expected);
}

TEST(LoadControl, KeepsWhatItShedsWhileFramesWaitALittle) {
  LoadControl shedding;
  Decide(shedding, kDropped, 2);
  for (const LoadLevel shed : Decide(shedding, {.wait = 0.7}, 100))
    EXPECT_EQ(shed, LoadLevel::kLines);
}

TEST(LoadControl, ShedsMappingAloneWhereOnlyMappingIsBehind) {
  LoadControl shedding;
  Load load = kInTime;
  for (int waiting = 0; waiting < LoadControl::kManyTasksWaiting; ++waiting) {
    load.tasks_waiting = waiting;
    EXPECT_EQ(shedding.Next(load), LoadLevel::kNothing);
  }
  load.tasks_waiting = LoadControl::kManyTasksWaiting;
  for (const LoadLevel shed : Decide(shedding, load, 50)) EXPECT_EQ(shed, LoadLevel::kMapping);
  load.tasks_waiting = 1;
  EXPECT_EQ(shedding.Next(load), LoadLevel::kMapping);
  load.tasks_waiting = 0;
  EXPECT_EQ(shedding.Next(load), LoadLevel::kNothing);
}

TEST(LoadControl, ADecisionFollowsFromTheLoadsAlone) {
  LoadControl a, b;
  for (int i = 0; i < 200; ++i) {
    const Load load{
        .wait = 0.01 * ((37 * i) % 200), .frames_dropped = i % 11 == 0, .tasks_waiting = i % 5};
    EXPECT_EQ(a.Next(load), b.Next(load));
  }
}

TEST(ReducedOptions, LeavesAllAsItIsWhereNothingIsShed) {
  const FeatureOptions features = ReducedOptions(FeatureOptions{}, LoadLevel::kNothing);
  EXPECT_EQ(features.point_count, FeatureOptions{}.point_count);
  EXPECT_EQ(features.line_count, FeatureOptions{}.line_count);
  EXPECT_EQ(FeatureShare(LoadLevel::kNothing), 1);
  const MappingOptions mapping = ReducedOptions(MappingOptions{}, LoadLevel::kNothing);
  EXPECT_EQ(mapping.fusion_neighbours, MappingOptions{}.fusion_neighbours);
  EXPECT_EQ(mapping.window.free_keyframes, MappingOptions{}.window.free_keyframes);
  EXPECT_EQ(mapping.ba.max_iterations, MappingOptions{}.ba.max_iterations);
}

TEST(ReducedOptions, TakesMappingThenLinesThenPoints) {
  const FeatureOptions usual;
  const MappingOptions mapping = ReducedOptions(MappingOptions{}, LoadLevel::kMapping);
  EXPECT_LT(mapping.creation.neighbours, MappingOptions{}.creation.neighbours);
  EXPECT_LT(mapping.window.free_keyframes, MappingOptions{}.window.free_keyframes);
  EXPECT_LT(mapping.window.fixed_keyframes, MappingOptions{}.window.fixed_keyframes);
  EXPECT_EQ(ReducedOptions(usual, LoadLevel::kMapping).line_count, usual.line_count);
  EXPECT_LT(ReducedOptions(usual, LoadLevel::kLines).line_count, usual.line_count);
  EXPECT_EQ(ReducedOptions(usual, LoadLevel::kLines).point_count, usual.point_count);
  EXPECT_LT(ReducedOptions(usual, LoadLevel::kPoints).line_count, usual.line_count);
  EXPECT_LT(ReducedOptions(usual, LoadLevel::kPoints).point_count, usual.point_count);
  EXPECT_EQ(FeatureShare(LoadLevel::kLines), 1);
  EXPECT_LT(FeatureShare(LoadLevel::kPoints), 1);
}

TEST(ReducedOptions, TurnsNothingOnOrOff) {
  FeatureOptions features;
  features.line_count = 0;
  features.point_count = 1;
  EXPECT_EQ(ReducedOptions(features, LoadLevel::kPoints).line_count, 0);
  EXPECT_EQ(ReducedOptions(features, LoadLevel::kPoints).point_count, 1);
  MappingOptions mapping;
  mapping.creation.neighbours = 0;
  mapping.window.free_keyframes = 1;
  EXPECT_EQ(ReducedOptions(mapping, LoadLevel::kMapping).creation.neighbours, 0);
  EXPECT_EQ(ReducedOptions(mapping, LoadLevel::kMapping).window.free_keyframes, 1);
}

}  // namespace
}  // namespace plumbline
