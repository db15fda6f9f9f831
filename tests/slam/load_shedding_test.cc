// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/load_shedding.h"

#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr Load kInTime{.wait = 0.1};
constexpr Load kLate{.wait = 1.5};
constexpr Load kDropped{.wait = 1.5, .frames_dropped = 2};

std::vector<Shed> Decide(LoadShedding& shedding, const Load& load, int frames) {
  std::vector<Shed> decided;
  for (int i = 0; i < frames; ++i) decided.push_back(shedding.Next(load));
  return decided;
}

TEST(LoadShedding, ShedsNothingInTime) {
  LoadShedding shedding;
  for (const Shed shed : Decide(shedding, kInTime, 100)) EXPECT_EQ(shed, Shed::kNothing);
}

TEST(LoadShedding, LetsSingleLateFramesPass) {
  LoadShedding shedding;
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(shedding.Next(kLate), Shed::kNothing);
    EXPECT_EQ(shedding.Next(kInTime), Shed::kNothing);
  }
}

TEST(LoadShedding, ShedsMoreInOrderWhileFramesAreLate) {
  LoadShedding shedding;
  const std::vector<Shed> expected = {Shed::kNothing,
                                      Shed::kMapping,
                                      Shed::kMapping,
                                      Shed::kLines,
                                      Shed::kLines,
                                      Shed::kPoints,
                                      Shed::kPoints,
                                      Shed::kPoints};
  EXPECT_EQ(Decide(shedding, kLate, 8), expected);
}

TEST(LoadShedding, DoesNotWaitForASecondFrameThatIsLeftOut) {
  LoadShedding shedding;
  const std::vector<Shed> expected = {Shed::kMapping, Shed::kLines, Shed::kPoints, Shed::kPoints};
  EXPECT_EQ(Decide(shedding, kDropped, 4), expected);
}

TEST(LoadShedding, EndsStepByStepWithTheLoad) {
  LoadShedding shedding;
  Decide(shedding, kDropped, 5);
  const int calm = LoadShedding::kCalmFrames;
  std::vector<Shed> expected;
  for (const Shed shed : {Shed::kPoints, Shed::kLines, Shed::kMapping}) {
    expected.insert(expected.end(), static_cast<std::size_t>(calm), shed);
  }
  expected.erase(expected.begin());  // the first calm frames end with the change
  expected.push_back(Shed::kNothing);
  EXPECT_EQ(Decide(shedding, kInTime, 3 * calm), expected);
}

TEST(LoadShedding, KeepsWhatItShedsWhileFramesWaitALittle) {
  LoadShedding shedding;
  Decide(shedding, kDropped, 2);
  for (const Shed shed : Decide(shedding, {.wait = 0.7}, 100)) EXPECT_EQ(shed, Shed::kLines);
}

TEST(LoadShedding, ShedsMappingAloneWhereOnlyMappingIsBehind) {
  LoadShedding shedding;
  Load load = kInTime;
  for (int waiting = 0; waiting < LoadShedding::kManyTasksWaiting; ++waiting) {
    load.tasks_waiting = waiting;
    EXPECT_EQ(shedding.Next(load), Shed::kNothing);
  }
  load.tasks_waiting = LoadShedding::kManyTasksWaiting;
  for (const Shed shed : Decide(shedding, load, 50)) EXPECT_EQ(shed, Shed::kMapping);
  load.tasks_waiting = 1;
  EXPECT_EQ(shedding.Next(load), Shed::kMapping);
  load.tasks_waiting = 0;
  EXPECT_EQ(shedding.Next(load), Shed::kNothing);
}

TEST(LoadShedding, ADecisionFollowsFromTheLoadsAlone) {
  LoadShedding a, b;
  for (int i = 0; i < 200; ++i) {
    const Load load{
        .wait = 0.01 * ((37 * i) % 200), .frames_dropped = i % 11 == 0, .tasks_waiting = i % 5};
    EXPECT_EQ(a.Next(load), b.Next(load));
  }
}

TEST(Lightened, LeavesAllAsItIsWhereNothingIsShed) {
  const FeatureOptions features = Lightened(FeatureOptions{}, Shed::kNothing);
  EXPECT_EQ(features.point_count, FeatureOptions{}.point_count);
  EXPECT_EQ(features.line_count, FeatureOptions{}.line_count);
  EXPECT_EQ(FeatureShare(Shed::kNothing), 1);
  const MappingOptions mapping = Lightened(MappingOptions{}, Shed::kNothing);
  EXPECT_EQ(mapping.fusion_neighbours, MappingOptions{}.fusion_neighbours);
  EXPECT_EQ(mapping.window.free_keyframes, MappingOptions{}.window.free_keyframes);
  EXPECT_EQ(mapping.ba.max_iterations, MappingOptions{}.ba.max_iterations);
}

TEST(Lightened, TakesMappingThenLinesThenPoints) {
  const FeatureOptions usual;
  const MappingOptions mapping = Lightened(MappingOptions{}, Shed::kMapping);
  EXPECT_LT(mapping.creation.neighbours, MappingOptions{}.creation.neighbours);
  EXPECT_LT(mapping.window.free_keyframes, MappingOptions{}.window.free_keyframes);
  EXPECT_LT(mapping.window.fixed_keyframes, MappingOptions{}.window.fixed_keyframes);
  EXPECT_EQ(Lightened(usual, Shed::kMapping).line_count, usual.line_count);
  EXPECT_LT(Lightened(usual, Shed::kLines).line_count, usual.line_count);
  EXPECT_EQ(Lightened(usual, Shed::kLines).point_count, usual.point_count);
  EXPECT_LT(Lightened(usual, Shed::kPoints).line_count, usual.line_count);
  EXPECT_LT(Lightened(usual, Shed::kPoints).point_count, usual.point_count);
  EXPECT_EQ(FeatureShare(Shed::kLines), 1);
  EXPECT_LT(FeatureShare(Shed::kPoints), 1);
}

TEST(Lightened, TurnsNothingOnOrOff) {
  FeatureOptions features;
  features.line_count = 0;
  features.point_count = 1;
  EXPECT_EQ(Lightened(features, Shed::kPoints).line_count, 0);
  EXPECT_EQ(Lightened(features, Shed::kPoints).point_count, 1);
  MappingOptions mapping;
  mapping.creation.neighbours = 0;
  mapping.window.free_keyframes = 1;
  EXPECT_EQ(Lightened(mapping, Shed::kMapping).creation.neighbours, 0);
  EXPECT_EQ(Lightened(mapping, Shed::kMapping).window.free_keyframes, 1);
}

}  // namespace
}  // namespace plumbline
