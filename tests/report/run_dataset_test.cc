// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_dataset.h"

#include "plumbline/io/trajectory_io.h"

#include "tests/report/poster_run.h"
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace run_dataset_test {

using testing::ElementsAre;

// The poster; the third image cannot be read.
class PosterWithAGap : public PosterDataset {
 public:
  PosterWithAGap() : PosterDataset(6) {}
  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    if (i == 2) return ImageFailure{"third.png", "it is cut short"};
    return PosterDataset::Read(i);
  }
};

SlamOptions InMode(RunMode mode) {
  SlamOptions options;
  options.slam.mode = mode;
  return options;
}

std::string TrajectoryOf(const RunResult& result) {
  return FormatTum(result.FinalTrajectory(result.MainMap().value()));
}

TEST(RunDataset, TracksAllFramesAndFinishesTheMap) {
  const RunResult result = RunDataset(PosterDataset(6));
  EXPECT_EQ(result.frames.size(), 6U);
  const Trajectory poses = result.FinalTrajectory(result.MainMap().value());
  ASSERT_EQ(poses.size(), 6U);
  EXPECT_NEAR(poses.back().world_from_camera.translation.x(), 5 * MovingPoster::kStep, 0.003);
}

TEST(RunDataset, IsTheSameInAThreadOfItsOwn) {
  const PosterDataset poster(6);
  EXPECT_EQ(TrajectoryOf(RunDataset(poster, InMode(RunMode::kInline))),
            TrajectoryOf(RunDataset(poster, InMode(RunMode::kLockstep))));
}

TEST(RunDataset, TellsOfEachFrameInOrder) {
  std::vector<std::string> told;
  RunDataset(PosterWithAGap(), {}, [&](const FrameRecord& record) {
    told.push_back(std::to_string(record.id.value) + record.reason);
  });
  EXPECT_THAT(told, ElementsAre("0", "1", "2image_unreadable", "3", "4", "5"));
}

TEST(RunDataset, EndsWhenAskedTo) {
  int frames = 0;
  const RunResult result = RunDataset(
      PosterDataset(6),
      InMode(RunMode::kInline),
      [&](const FrameRecord&) { ++frames; },
      [&] { return frames >= 3; });
  EXPECT_EQ(result.frames.size(), 3U);
  EXPECT_TRUE(result.MainMap().has_value());
}

TEST(RunDataset, WaitsForFramesThatAreToCome) {
  const auto begin = std::chrono::steady_clock::now();
  const RunResult result = RunDataset(PosterDataset(4), InMode(RunMode::kLive));
  const auto recorded =
      std::chrono::nanoseconds(MovingPoster::StampNs(3) - MovingPoster::StampNs(0));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, recorded);
  EXPECT_EQ(result.frames.size(), 4U);
}

}  // namespace run_dataset_test
}  // namespace plumbline
