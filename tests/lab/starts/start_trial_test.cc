// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_trial.h"

#include "tests/lab/starts/start_fixtures.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

StartRecord Try(Initializer& initializer,
                const StartTruth& truth,
                const StartLimits& limits = {},
                std::vector<double>* times = nullptr,
                int in_time = 12) {
  const StartFrames frames = BlankFrame;
  int maps = 0;
  const StartTask task{
      frames, truth, StartCamera(), limits, [&maps](const auto& /*record*/, const auto& map) {
        maps += !map.views.empty();
      }};
  std::vector<double> milliseconds;
  const StartRecord record = TryStart({1, in_time, 12}, task, initializer, milliseconds);
  EXPECT_EQ(maps, record.map ? 1 : 0);
  if (times != nullptr) *times = milliseconds;
  return record;
}

TEST(StartTrial, ARightMapIsRecognised) {
  const SidewaysTruth truth;
  FakeInitializer initializer(7, truth.Map(1, 7, 3));
  std::vector<double> times;
  const StartRecord record = Try(initializer, truth, {}, &times);
  EXPECT_EQ(record.outcome, StartOutcome::kRight);
  EXPECT_EQ(record.reason, "");
  EXPECT_EQ(record.frame, 1);
  EXPECT_EQ(record.offered, 6) << "1, 2, 4, 5, 6, 7";
  EXPECT_EQ(times.size(), 6U);
  ASSERT_TRUE(record.map);
  EXPECT_EQ(record.map->frames, 6);
  EXPECT_NEAR(record.map->seconds, 0.3, 1e-9);
  EXPECT_EQ(record.map->reference, 1);
  EXPECT_EQ(record.map->newest, 7);
  EXPECT_EQ(record.map->estimated_parallax_deg, 3);
  EXPECT_EQ(record.map->points, 192);
  // 12 cm at 2.25 m, give or take what the depths and directions do.
  EXPECT_NEAR(*record.map->parallax_deg, 2.9, 0.5);
  EXPECT_GT(*record.greatest_parallax_deg, 4);
}

TEST(StartTrial, TheReferenceMayBeALaterFrame) {
  const SidewaysTruth truth;
  FakeInitializer right(9, truth.Map(4, 9, 1));
  EXPECT_EQ(Try(right, truth).outcome, StartOutcome::kRight);
  InitialMap mislabelled = truth.Map(1, 9, 1);
  mislabelled.views.front().frame.id = FrameId{4};
  FakeInitializer other(9, mislabelled);
  EXPECT_EQ(Try(other, truth).outcome, StartOutcome::kWrong);
}

TEST(StartTrial, AWrongMapIsRecognised) {
  const SidewaysTruth truth;
  InitialMap map = truth.Map(1, 7, 1);
  map.views.back().cam_from_world.translation *= -1;
  FakeInitializer initializer(7, map);
  const StartRecord record = Try(initializer, truth);
  EXPECT_EQ(record.outcome, StartOutcome::kWrong);
  EXPECT_EQ(record.reason, "direction");
}

TEST(StartTrial, WithoutAMapTheLastReasonIsKept) {
  FakeInitializer initializer(std::nullopt, {});
  const StartRecord record = Try(initializer, SidewaysTruth());
  EXPECT_EQ(record.outcome, StartOutcome::kWaiting);
  EXPECT_EQ(record.reason, "too_little_parallax");
  EXPECT_EQ(record.offered, 10);
  EXPECT_FALSE(record.map);
}

TEST(StartTrial, ARightMapAfterTheTimeIsLate) {
  const SidewaysTruth truth;
  const auto outcome = [&](int in_time) {
    FakeInitializer initializer(7, truth.Map(1, 7, 3));
    return Try(initializer, truth, {}, nullptr, in_time).outcome;
  };
  EXPECT_EQ(outcome(8), StartOutcome::kRight);
  EXPECT_EQ(outcome(7), StartOutcome::kLate);
}

TEST(StartTrial, AWrongMapAfterTheTimeIsWrong) {
  const SidewaysTruth truth;
  InitialMap map = truth.Map(1, 7, 1);
  map.views.back().cam_from_world.translation *= -1;
  FakeInitializer initializer(7, map);
  EXPECT_EQ(Try(initializer, truth, {}, nullptr, 4).outcome, StartOutcome::kWrong);
}

TEST(StartTrial, WhatIsPossibleCountsFramesInTimeOnly) {
  const SidewaysTruth truth;
  const auto greatest = [&](int in_time) {
    FakeInitializer initializer(std::nullopt, {});
    return *Try(initializer, truth, {}, nullptr, in_time).greatest_parallax_deg;
  };
  EXPECT_LT(greatest(5), 0.6 * greatest(12));
}

TEST(StartTrial, AMapOfAStillCameraIsWrongWhereParallaxIsAskedFor) {
  const SidewaysTruth truth(0.0001);
  FakeInitializer initializer(7, truth.Map(1, 7, 1));
  EXPECT_EQ(Try(initializer, truth).outcome, StartOutcome::kRight);
  StartLimits limits;
  limits.parallax_deg = 0.5;
  const StartRecord record = Try(initializer, truth, limits);
  EXPECT_EQ(record.outcome, StartOutcome::kWrong);
  EXPECT_EQ(record.reason, "parallax");
  EXPECT_LT(*record.greatest_parallax_deg, 0.1);
}

class NothingKnown : public StartTruth {
  std::optional<Rigid3> WorldFromCamera(int /*frame*/) const override { return std::nullopt; }
  std::shared_ptr<const TrueDepth> DepthAt(int /*frame*/) const override { return nullptr; }
};

TEST(StartTrial, WithoutTruthNothingIsJudged) {
  FakeInitializer initializer(7, SidewaysTruth().Map(1, 7, 1));
  const StartRecord record = Try(initializer, NothingKnown());
  EXPECT_EQ(record.outcome, StartOutcome::kUnjudged);
  EXPECT_FALSE(record.greatest_parallax_deg);
  EXPECT_FALSE(record.map->parallax_deg);
}

}  // namespace
}  // namespace plumbline
