// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/pipeline.h"

#include "tests/support/moving_poster.h"
#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace pipeline_test {

SlamOptions InMode(RunMode mode) {
  SlamOptions options;
  options.slam.mode = mode;
  return options;
}

struct Outcome {
  std::vector<std::string> status;
  std::vector<std::int64_t> stamps;
  Trajectory causal, final, keyframes;
};

// A run over the poster; without threads each frame is done before the next one comes.
Outcome RunPoster(RunMode mode, int frames, const Execution& execution = {}) {
  System system(MovingPoster::MakeCalibration(), InMode(mode), execution);
  const MovingPoster poster;
  Outcome outcome;
  Pipeline pipeline(system, [&](const FrameRecord& record, const FrameView& view) {
    outcome.status.push_back(std::string(NameOf(record.status)) + record.reason);
    outcome.stamps.push_back(record.stamp_ns);
    EXPECT_EQ(view.images.left.empty(), record.status == FrameStatus::kSkipped);
  });
  for (int i = 0; i < frames; ++i) {
    if (i == 4) {
      pipeline.Skip(MovingPoster::StampNs(i), "image_unreadable");
    } else {
      pipeline.Feed(poster.Frame(i));
    }
    while (!execution.threads && (pipeline.WorkOnce() || system.MapOnce())) {
    }
  }
  const RunResult result = pipeline.Finish();
  outcome.causal = result.CausalTrajectory(MapId{0});
  outcome.final = result.FinalTrajectory(MapId{0});
  outcome.keyframes = result.KeyFrameTrajectory(MapId{0});
  return outcome;
}

bool SameBits(const Trajectory& a, const Trajectory& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.stamp_ns == y.stamp_ns &&
           x.world_from_camera.rotation.coeffs() == y.world_from_camera.rotation.coeffs() &&
           x.world_from_camera.translation == y.world_from_camera.translation;
  });
}

TEST(Pipeline, LockstepGivesTheBitsOfInline) {
  const Outcome inline_run = RunPoster(RunMode::kInline, 15);
  const Outcome lockstep = RunPoster(RunMode::kLockstep, 15);
  EXPECT_EQ(inline_run.status, lockstep.status);
  EXPECT_EQ(inline_run.stamps, lockstep.stamps);
  EXPECT_EQ(inline_run.final.size(), 14U);
  EXPECT_TRUE(SameBits(inline_run.causal, lockstep.causal));
  EXPECT_TRUE(SameBits(inline_run.final, lockstep.final));
  EXPECT_TRUE(SameBits(inline_run.keyframes, lockstep.keyframes));
}

TEST(Pipeline, LiveTracksEveryFrameThatLeavesItTime) {
  const Outcome live = RunPoster(RunMode::kLive, 6, {.threads = false});
  const std::vector<std::string> expected = {
      "tracked", "tracked", "tracked", "tracked", "skippedimage_unreadable", "tracked"};
  EXPECT_EQ(live.status, expected);
}

TEST(Pipeline, SkipsFramesWhoseMaskIsBlack) {
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  std::vector<std::string> reasons;
  Pipeline pipeline(system, [&](const FrameRecord& record, const FrameView&) {
    reasons.push_back(record.reason);
  });
  const MovingPoster poster;
  for (int i = 0; i < 3; ++i) {
    SensorFrame frame = poster.Frame(i);
    GrayImage mask(frame.left.width(), frame.left.height(), 0);
    if (i == 2) mask.at(7, 9) = 255;
    if (i > 0) frame.left_mask = std::make_shared<const GrayImage>(mask);
    pipeline.Feed(std::move(frame));
  }
  pipeline.Finish();
  EXPECT_EQ(reasons[1], Pipeline::kBlackMask);
  EXPECT_NE(reasons[0], Pipeline::kBlackMask);
  EXPECT_NE(reasons[2], Pipeline::kBlackMask);
}

// A pipeline whose worker stands still from its first frame on until it is released.
class LiveTest : public ::testing::Test {
 protected:
  void Release() {
    {
      const std::lock_guard lock(mutex_);
      released_ = true;
    }
    changed_.notify_all();
  }
  void WaitUntilBusy() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !reasons_.empty(); });
  }

  System system_{MovingPoster::MakeCalibration(), InMode(RunMode::kLive)};
  MovingPoster poster_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool released_ = false;
  std::vector<std::string> reasons_;
  std::vector<std::int64_t> stamps_;
  std::unique_ptr<Pipeline> pipeline_ =
      std::make_unique<Pipeline>(system_, [this](const FrameRecord& record, const FrameView&) {
        std::unique_lock lock(mutex_);
        reasons_.push_back(record.reason);
        stamps_.push_back(record.stamp_ns);
        changed_.notify_all();
        changed_.wait(lock, [&] { return released_; });
      });
};

TEST_F(LiveTest, DropsTheOldestWaitingFrameAndSaysSoInOrder) {
  pipeline_->Feed(poster_.Frame(0));
  WaitUntilBusy();
  for (int i = 1; i <= 4; ++i) pipeline_->Feed(poster_.Frame(i));  // never blocks
  Release();
  pipeline_->Finish();
  EXPECT_EQ(reasons_, (std::vector<std::string>{"", "dropped", "dropped", "", ""}));
  ASSERT_EQ(stamps_.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(stamps_[static_cast<std::size_t>(i)], MovingPoster::StampNs(i));
  }
}

// A reason is a word of the caller; only the pipeline itself drops frames.
TEST_F(LiveTest, AFrameThatTheCallerLeftOutIsNotDropped) {
  Release();
  pipeline_->Skip(MovingPoster::StampNs(0), Pipeline::kDropped);
  const RunResult result = pipeline_->Finish();
  ASSERT_EQ(result.frames.size(), 1U);
  EXPECT_EQ(result.frames[0].shed, LoadLevel::kNothing);
}

TEST_F(LiveTest, FramesThatCannotBeReadTakeNoPlaceInTheQueue) {
  pipeline_->Feed(poster_.Frame(0));
  WaitUntilBusy();
  pipeline_->Feed(poster_.Frame(1));
  pipeline_->Skip(MovingPoster::StampNs(2), "image_unreadable");
  pipeline_->Feed(poster_.Frame(3));
  Release();
  pipeline_->Finish();
  EXPECT_EQ(reasons_, (std::vector<std::string>{"", "", "image_unreadable", ""}));
}

TEST_F(LiveTest, FramesThatCannotBeReadDropNoWaitingFrame) {
  pipeline_->Feed(poster_.Frame(0));
  WaitUntilBusy();
  pipeline_->Feed(poster_.Frame(1));
  pipeline_->Feed(poster_.Frame(2));
  pipeline_->Skip(MovingPoster::StampNs(3), "image_unreadable");
  Release();
  pipeline_->Finish();
  EXPECT_EQ(reasons_, (std::vector<std::string>{"", "", "", "image_unreadable"}));
}

TEST_F(LiveTest, EndsWithFramesWaiting) {
  pipeline_->Feed(poster_.Frame(0));
  WaitUntilBusy();
  pipeline_->Feed(poster_.Frame(1));
  Release();
  pipeline_.reset();
  EXPECT_LE(reasons_.size(), 2U);
}

InertialCalibration GyroscopeAtTheCamera() {
  InertialCalibration calibration;
  calibration.imu_from_left = Rigid3();
  return calibration;
}

// Samples at 200 Hz since the frame before, of a camera that does not turn.
std::vector<InertialSample> SamplesBefore(int frame) {
  std::vector<InertialSample> samples;
  const std::int64_t from = MovingPoster::StampNs(frame - 1), to = MovingPoster::StampNs(frame);
  for (std::int64_t ns = from; ns < to; ns += 5'000'000) {
    samples.push_back({ns + 5'000'000, {0, 0, 0}, {0, -9.81, 0}});
  }
  return samples;
}

// A gap of more than 150 ms would leave the turn over them unknown. (That to the second frame of a
// map is not compared.)
TEST_F(LiveTest, SamplesOfDroppedAndSkippedFramesGoToTheNextFrame) {
  system_.UseInertial(GyroscopeAtTheCamera());
  const auto feed = [&](int frame) {
    pipeline_->AddInertial(SamplesBefore(frame));
    pipeline_->Feed(poster_.Frame(frame));
  };
  Release();
  for (const int i : {0, 1}) {
    feed(i);
    pipeline_->Drain();
  }
  {
    const std::lock_guard lock(mutex_);
    released_ = false;
  }
  feed(2);
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return reasons_.size() == 3; });
  }
  for (int i = 3; i <= 9; ++i) feed(i);  // 3 to 7 are dropped
  Release();
  pipeline_->Drain();
  for (int i = 10; i <= 13; ++i) {
    pipeline_->AddInertial(SamplesBefore(i));
    pipeline_->Skip(MovingPoster::StampNs(i), "image_unreadable");
  }
  feed(14);
  const RunResult result = pipeline_->Finish();
  EXPECT_EQ(std::count(reasons_.begin(), reasons_.end(), "dropped"), 5);
  EXPECT_EQ(std::count(reasons_.begin(), reasons_.end(), ""), 6);
  ASSERT_TRUE(result.inertial);
  EXPECT_EQ(result.inertial->turns, 4);  // 1 to 2, 2 to 8, 8 to 9, 9 to 14
  EXPECT_EQ(result.inertial->contradicted, 0);
}

TEST(Pipeline, TellsNoTurnOverSamplesThatAreMissing) {
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  system.UseInertial(GyroscopeAtTheCamera());
  Pipeline pipeline(system, [](const FrameRecord&, const FrameView&) {});
  const MovingPoster poster;
  for (const int i : {0, 1, 2, 8}) {  // without the samples of the frames between
    pipeline.AddInertial(SamplesBefore(i));
    pipeline.Feed(poster.Frame(i));
  }
  EXPECT_EQ(pipeline.Finish().inertial->turns, 1);
}

TEST(Pipeline, SamplesOfAnotherSensorLoseNoFrame) {
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  system.UseInertial(GyroscopeAtTheCamera());
  int tracked = 0;
  Pipeline pipeline(system, [&](const FrameRecord& record, const FrameView&) {
    tracked += record.status == FrameStatus::kTracked;
  });
  const MovingPoster poster;
  for (int i = 0; i < 8; ++i) {
    std::vector<InertialSample> samples = SamplesBefore(i);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      samples[k].angular_rate = {20 + 0.1 * static_cast<double>(k), -30, 10};
    }
    pipeline.AddInertial(samples);
    pipeline.Feed(poster.Frame(i));
  }
  EXPECT_EQ(tracked, 8);
}

class PipelineFailure : public ::testing::TestWithParam<RunMode> {};
INSTANTIATE_TEST_SUITE_P(Modes,
                         PipelineFailure,
                         ::testing::Values(RunMode::kInline, RunMode::kLockstep, RunMode::kLive),
                         [](const auto& mode) { return std::string(NameOf(mode.param)); });

TEST_P(PipelineFailure, ComesOutOfFeedOrFinish) {
  System system(MovingPoster::MakeCalibration(), InMode(GetParam()));
  Pipeline pipeline(system, [](const FrameRecord&, const FrameView&) {});
  const auto feed = [&] {
    pipeline.Feed(MovingPoster().Frame(0));
    pipeline.Feed({MovingPoster::StampNs(1), GrayImage(40, 30), GrayImage(40, 30), {}});
    pipeline.Finish();
  };
  EXPECT_THROW(feed(), InputError);
}

TEST_P(PipelineFailure, LeavesTheResultOfTheFramesBefore) {
  System system(MovingPoster::MakeCalibration(), InMode(GetParam()));
  Pipeline pipeline(system, [](const FrameRecord& record, const FrameView&) {
    if (record.id == FrameId{2}) throw InputError("no place to write to");
  });
  const MovingPoster poster;
  try {
    for (int i = 0; i < 3; ++i) {
      pipeline.Feed(poster.Frame(i));
      pipeline.Drain();
    }
  } catch (const InputError&) {  // by Feed in inline mode
  }
  std::exception_ptr failure;
  const RunResult result = pipeline.Finish({}, &failure);
  EXPECT_EQ(failure == nullptr, GetParam() == RunMode::kInline);
  EXPECT_EQ(result.FinalTrajectory(MapId{0}).size(), 3U);
}

TEST_P(PipelineFailure, OfTheObserverDoesToo) {
  System system(MovingPoster::MakeCalibration(), InMode(GetParam()));
  Pipeline pipeline(system, [](const FrameRecord&, const FrameView&) {
    throw InputError("no place to write to");
  });
  const auto feed = [&] {
    pipeline.Skip(MovingPoster::StampNs(0), "image_unreadable");
    pipeline.Finish();
  };
  EXPECT_THROW(feed(), InputError);
}

}  // namespace pipeline_test
}  // namespace plumbline
