// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Live runs on a machine whose speed and clock the test decides about: nothing here depends on how
// fast the tests run.
#include "plumbline/slam/mapper_thread.h"
#include "plumbline/slam/pipeline.h"

#include "tests/support/moving_poster.h"
#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using std::chrono::milliseconds;

constexpr int kIntervalMs = 50;  // MovingPoster's

// How long things take, of frame number n.
struct Speed {
  std::function<int(int)> frame_ms;
  std::function<int(int)> keyframe_ms;
};

Speed Constant(int frame_ms, int keyframe_ms) {
  return {[=](int) { return frame_ms; }, [=](int) { return keyframe_ms; }};
}

// A live run with one processor for tracking and one for mapping. Time goes on in milliseconds; a
// keyframe is in the map when its time has passed.
class SimulatedRun {
 public:
  using Source = std::function<SensorFrame(int)>;

  explicit SimulatedRun(Speed speed, const Source& source = {})
      : speed_(std::move(speed)),
        source_(source ? source : [this](int i) { return poster_.Frame(i); }),
        system_(MovingPoster::MakeCalibration(), Options(), Steps()),
        pipeline_(system_, [this](const FrameRecord& record, const FrameView&) {
          skipped_ = record.status == FrameStatus::kSkipped;
          tracked_ += record.status == FrameStatus::kTracked;
          most_waiting_ = std::max(most_waiting_, system_.TasksWaiting());
        }) {}

  void Play(int frames) {
    for (const int end = (fed_ + frames) * kIntervalMs; now_ms_ < end; ++now_ms_) {
      if (now_ms_ % kIntervalMs == 0) pipeline_.Feed(source_(fed_++));
      Track();
      Map();
    }
  }
  void Finish() { result_ = pipeline_.Finish(); }

  // After Finish.
  const RunResult& result() const { return result_; }
  const FrameLog& frames() const { return result_.frames; }
  // So far.
  int tracked() const { return tracked_; }
  std::size_t most_waiting() const { return most_waiting_; }

  int Count(const std::function<bool(const FrameRecord&)>& holds) const {
    return static_cast<int>(std::count_if(frames().begin(), frames().end(), holds));
  }
  int CountStatus(FrameStatus status) const {
    return Count([&](const FrameRecord& r) { return r.status == status; });
  }
  int CountLoadLevel(LoadLevel shed) const {
    return Count([&](const FrameRecord& r) { return r.shed == shed; });
  }

 private:
  static SlamOptions Options() {
    SlamOptions options;
    options.slam.mode = RunMode::kLive;
    return options;
  }
  Execution Steps() {
    return {.threads = false,
            .now = [this] { return Execution::Clock::time_point(milliseconds(now_ms_)); }};
  }

  void Track() {
    while (now_ms_ >= tracker_free_ms_ && pipeline_.WorkOnce()) {
      if (!skipped_) tracker_free_ms_ = now_ms_ + speed_.frame_ms(fed_);
    }
  }
  void Map() {
    if (mapped_ms_ && now_ms_ >= *mapped_ms_) {
      system_.MapOnce();
      mapped_ms_.reset();
    }
    if (!mapped_ms_ && system_.TasksWaiting() > 0) {
      mapped_ms_ = now_ms_ + speed_.keyframe_ms(fed_);
    }
  }

  Speed speed_;
  MovingPoster poster_;
  Source source_;
  int now_ms_ = 0;
  int tracker_free_ms_ = 0;
  std::optional<int> mapped_ms_;
  int fed_ = 0;
  bool skipped_ = false;
  int tracked_ = 0;
  std::size_t most_waiting_ = 0;
  System system_;
  Pipeline pipeline_;
  RunResult result_;
};

// Every frame where the truth has it, and hanging on keyframes that the map knows.
void ExpectWholeTrajectory(const SimulatedRun& run) {
  ASSERT_EQ(run.result().atlas.maps().size(), 1U);
  run.result().atlas.maps().at(MapId{0}).CheckInvariants();
  const Trajectory final = run.result().FinalTrajectory(MapId{0});
  ASSERT_EQ(static_cast<int>(final.size()), run.CountStatus(FrameStatus::kTracked));
  for (const StampedPose& pose : final) {
    const auto frame =
        static_cast<double>(pose.stamp_ns - MovingPoster::StampNs(0)) / (1e6 * kIntervalMs);
    const Eigen::Vector3d expected(MovingPoster::kStep * frame, 0, 0);
    EXPECT_LT((pose.world_from_camera.translation - expected).norm(), 0.02) << frame;
  }
}

// Which frames were found worth a keyframe.
std::vector<std::int64_t> Decided(const SimulatedRun& run) {
  std::vector<std::int64_t> decided;
  for (const FrameRecord& record : run.frames()) {
    if (record.keyframe || record.demoted) decided.push_back(record.id.value);
  }
  return decided;
}

TEST(LiveRun, ShedsNothingWhereThereIsTime) {
  SimulatedRun run(Constant(30, 60));
  run.Play(60);
  run.Finish();
  EXPECT_EQ(run.CountStatus(FrameStatus::kTracked), 60);
  EXPECT_EQ(run.CountLoadLevel(LoadLevel::kNothing), 60);
  EXPECT_EQ(run.Count([](const FrameRecord& r) { return r.demoted; }), 0);
  ExpectWholeTrajectory(run);
}

TEST(LiveRun, RepeatsWithTheSameClock) {
  const auto poses = [] {
    SimulatedRun run(Constant(70, 400));
    run.Play(30);
    run.Finish();
    return run.result().FinalTrajectory(MapId{0});
  };
  const Trajectory a = poses();
  const Trajectory b = poses();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].stamp_ns, b[i].stamp_ns);
    EXPECT_EQ(a[i].world_from_camera.translation, b[i].world_from_camera.translation);
  }
}

// The poster moves out of the first keyframe's sight long before mapping gets to the second one.
TEST(LiveRun, FollowsTheCameraWithoutMapping) {
  SimulatedRun run(Constant(20, 1'000'000));
  run.Play(125);
  EXPECT_EQ(run.tracked(), 125);
  EXPECT_EQ(run.most_waiting(), MapperThread::kMaxWaiting);
  run.Finish();
  ExpectWholeTrajectory(run);
}

TEST(LiveRun, GivesUpTheKeyFramesThatMappingHasNoTimeFor) {
  SimulatedRun run(Constant(20, 3000));
  run.Play(125);
  run.Finish();
  const int demoted = run.Count([](const FrameRecord& r) { return r.demoted; });
  const int keyframes = run.Count([](const FrameRecord& r) { return r.keyframe; });
  EXPECT_GT(demoted, 0);
  EXPECT_GT(keyframes, 2);
  EXPECT_EQ(static_cast<int>(Decided(run).size()), demoted + keyframes);
  // Nothing hangs on one that never came to be.
  const Map& map = run.result().atlas.maps().at(MapId{0});
  for (const FrameRecord& record : run.frames()) {
    EXPECT_FALSE(record.keyframe && record.demoted);
    EXPECT_NO_THROW(map.PoseOf(record.reference)) << record.id.value;
  }
  ExpectWholeTrajectory(run);
}

// What is tracked against is not quite the same with and without mapping, so that a frame sooner or
// later may become a keyframe; where some are given up, others follow in their place.
TEST(LiveRun, DecidesAboutKeyFramesWhateverTheLoadOfMapping) {
  const auto decided = [](int keyframe_ms) {
    SimulatedRun run(Constant(20, keyframe_ms));
    run.Play(70);
    run.Finish();
    return static_cast<double>(Decided(run).size());
  };
  const double at_once = decided(1);
  EXPECT_GT(at_once, 4);
  EXPECT_NEAR(decided(300), at_once, 1);
  EXPECT_NEAR(decided(1'000'000), at_once, 0.5 * at_once);
}

TEST(LiveRun, ShedsInOrderWhereTrackingIsSlow) {
  SimulatedRun run(Constant(140, 200));
  run.Play(100);
  run.Finish();
  std::vector<LoadLevel> first;  // in the order in which each was first shed
  for (const FrameRecord& record : run.frames()) {
    if (record.status == FrameStatus::kSkipped) {
      EXPECT_EQ(record.reason, Pipeline::kDropped);
      EXPECT_EQ(record.shed, LoadLevel::kFrame);
      continue;
    }
    EXPECT_NE(record.shed, LoadLevel::kFrame);
    if (std::find(first.begin(), first.end(), record.shed) == first.end())
      first.push_back(record.shed);
  }
  EXPECT_EQ(first,
            (std::vector<LoadLevel>{
                LoadLevel::kNothing, LoadLevel::kMapping, LoadLevel::kLines, LoadLevel::kPoints}));
  EXPECT_EQ(run.CountStatus(FrameStatus::kLost), 0);
  EXPECT_LE(run.CountStatus(FrameStatus::kSkipped), 68);
  ExpectWholeTrajectory(run);
}

TEST(LiveRun, ShedsNothingAnyMoreWhenTheLoadIsGone) {
  SimulatedRun run({[](int frame) { return frame < 40 ? 140 : 20; },
                    [](int frame) { return frame < 40 ? 800 : 20; }});
  run.Play(80);
  run.Finish();
  EXPECT_GT(run.CountLoadLevel(LoadLevel::kPoints), 0);
  const auto& frames = run.frames();
  for (std::size_t i = 70; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].shed, LoadLevel::kNothing) << i;
    EXPECT_EQ(frames[i].status, FrameStatus::kTracked) << i;
  }
  ExpectWholeTrajectory(run);
}

// The camera sees another place from frame 30 on, for some frames.
SimulatedRun::Source AwayFor(const MovingPoster& poster, int frames) {
  return [&poster, frames](int i) {
    return i >= 30 && i < 30 + frames ? MovingPoster::StrangeFrame(i) : poster.Frame(i);
  };
}

TEST(LiveRun, ANewMapWaitsAMomentForTheOldOne) {
  const MovingPoster poster;
  SimulatedRun run(Constant(20, 60), AwayFor(poster, 15));  // more than tracking.new_map_after
  run.Play(60);
  run.Finish();
  EXPECT_EQ(run.CountStatus(FrameStatus::kLost), 15);
  ExpectWholeTrajectory(run);
}

// And becomes part of the old one as soon as it is seen to show the same place.
TEST(LiveRun, ANewMapStartsAfterThat) {
  const MovingPoster poster;
  SimulatedRun run(Constant(20, 60), AwayFor(poster, 30));
  run.Play(80);
  run.Finish();
  const auto in_new_map = [](const FrameRecord& frame) { return frame.map == MapId{1}; };
  EXPECT_TRUE(std::any_of(run.frames().begin(), run.frames().end(), in_new_map));
  EXPECT_EQ(run.result().atlas.maps().size(), 1U);
  ASSERT_EQ(run.result().events.joins.size(), 1U);
  EXPECT_EQ(run.result().events.joins.front().gone, MapId{1});
  EXPECT_EQ(run.frames().back().map, MapId{0});
}

}  // namespace
}  // namespace plumbline
