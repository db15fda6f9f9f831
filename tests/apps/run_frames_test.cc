// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/run_frames.h"

#include "tests/io/scratch_folder.h"
#include "tests/report/poster_run.h"
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace run_frames_test {

using testing::HasSubstr;

// Frames in order; from one of them on, reading does something else.
class FailingDataset : public PosterDataset {
 public:
  FailingDataset(std::size_t from, std::function<void()> fail)
      : PosterDataset(8), from_(from), fail_(std::move(fail)) {}
  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    if (i >= from_) fail_();
    return PosterDataset::Read(i);
  }

 private:
  std::size_t from_;
  std::function<void()> fail_;
};

struct Outcome {
  std::string failure = "none";
  std::ptrdiff_t rows = 0;  // of the causal trajectory in the journal
  std::size_t frames = 0;   // of the finished system
  std::size_t poses = 0;
};

Outcome RunPoster(std::size_t from, const std::function<void()>& fail, RunMode mode) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  SlamOptions options;
  options.slam.mode = mode;
  System system(MovingPoster::MakeCalibration(), options);
  RunFrames input;
  input.dataset = std::make_shared<FailingDataset>(from, fail);
  input.frames = {0, 1, 2, 3, 4, 5, 6, 7};
  KeptViews views(input);
  const Processed processed = ProcessFrames(input, true, system, folder, views);
  Outcome outcome;
  try {
    if (processed.failure) std::rethrow_exception(processed.failure);
  } catch (const std::exception& error) {
    outcome.failure = error.what();
  }
  const std::string causal = Contents(folder.part() / "trajectory_causal.txt");
  outcome.rows = std::count(causal.begin(), causal.end(), '\n');
  outcome.frames = processed.result.frames.size();
  outcome.poses = processed.result.FinalTrajectory(MapId{0}).size();
  return outcome;
}

TEST(ProcessFrames, KeepsWhatWasDoneBeforeMemoryOrThreadsRanOut) {
  for (const RunMode mode : {RunMode::kInline, RunMode::kLockstep}) {
    const Outcome memory = RunPoster(
        5, [] { throw std::bad_alloc(); }, mode);
    EXPECT_EQ(memory.failure, "out of memory after 5 of 8 frames");
    EXPECT_EQ(memory.rows, 5);
    EXPECT_EQ(memory.frames, 5U);
    EXPECT_EQ(memory.poses, 5U);
    const auto no_thread = [] {
      throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
    };
    EXPECT_EQ(RunPoster(3, no_thread, mode).failure,
              "no further thread can be started after 3 of 8 frames");
    EXPECT_EQ(RunPoster(3, no_thread, mode).poses, 3U);
    EXPECT_EQ(RunPoster(8, no_thread, mode).failure, "none");
  }
}

TEST(ProcessFrames, ThrowsWhenNothingWasDone) {
  EXPECT_THAT(MessageOf([] {
                RunPoster(
                    0, [] { throw std::bad_alloc(); }, RunMode::kInline);
              }),
              HasSubstr("out of memory after 0 of 8 frames"));
}

// A run has no frames where somebody asks to stop before the first one.
TEST(ProcessFrames, LeavesNothingOfARunWithoutFrames) {
  const ScratchFolder scratch;
  {
    RunFolder folder(scratch / "out");
    System system(MovingPoster::MakeCalibration(), SlamOptions{});
    RunFrames input;
    input.dataset = std::make_shared<PosterDataset>(8);
    KeptViews views(input);
    const Processed processed = ProcessFrames(input, true, system, folder, views);
    EXPECT_FALSE(processed.failure);
  }
  EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

}  // namespace run_frames_test
}  // namespace plumbline
