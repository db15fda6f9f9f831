// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/background_adjustment.h"

#include "plumbline/base/error.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/pending_keyframes.h"
#include "plumbline/tracking/tracker.h"

#include "tests/support/true_map.h"
#include <atomic>
#include <chrono>
#include <future>
#include <latch>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Worker = BackgroundAdjustment::Worker;
constexpr Worker kWorkers[] = {Worker::kCaller, Worker::kThread, Worker::kThreadOfLowPriority};

// Says which map it was asked about: the oldest keyframe's id is the number of keyframes.
MapCorrection CountKeyFrames(const Map& map, const StopCheck&) {
  MapCorrection correction;
  correction.keyframes[KeyFrameId{static_cast<std::int64_t>(map.keyframes().size())}] = {};
  return correction;
}

Map MapOf(int keyframes) {
  const SyntheticWorld world = MakeSyntheticWorld(20, 5);
  std::vector<Rigid3> poses;
  for (int k = 0; k < keyframes; ++k) poses.push_back(PoseOnPath(4 * k));
  return MakeTrueMap(world, poses, {}).map;
}

std::int64_t Told(const std::optional<BackgroundAdjustment::Result>& result) {
  return result ? result->correction.keyframes.begin()->first.value : -1;
}

TEST(BackgroundAdjustment, TakesEffectAtTheFrameThatItIsDueAndOnce) {
  for (const Worker worker : kWorkers) {
    BackgroundAdjustment adjustment(worker);
    EXPECT_FALSE(adjustment.TakeDue(100));
    adjustment.Begin(MapOf(3), 10, CountKeyFrames);
    EXPECT_TRUE(adjustment.Running());
    EXPECT_FALSE(adjustment.TakeDue(9));
    EXPECT_EQ(Told(adjustment.TakeDue(10)), 3);
    EXPECT_FALSE(adjustment.TakeDue(11));
    EXPECT_FALSE(adjustment.Running());
  }
}

TEST(BackgroundAdjustment, SeesTheMapAsItWasWhenItBegan) {
  Map map = MapOf(4);
  BackgroundAdjustment adjustment(Worker::kCaller);
  adjustment.Begin(map, 0, CountKeyFrames);
  map.Apply({edit::RemoveKeyFrame{KeyFrameId{2}}});
  EXPECT_EQ(Told(adjustment.TakeDue(0)), 4);
}

TEST(BackgroundAdjustment, ALaterOneTakesThePlaceOfAnother) {
  for (const Worker worker : kWorkers) {
    BackgroundAdjustment adjustment(worker);
    adjustment.Begin(MapOf(3), 10, CountKeyFrames);
    adjustment.Begin(MapOf(5), 20, CountKeyFrames);
    EXPECT_FALSE(adjustment.TakeDue(19));
    EXPECT_EQ(Told(adjustment.TakeDue(20)), 5);
  }
}

TEST(BackgroundAdjustment, IsStoppedWhenItIsGivenUp) {
  std::atomic<bool> begun = false;
  const auto until_stopped = [&](const Map&, const StopCheck& stop) {
    begun = true;
    while (!stop()) std::this_thread::yield();
    return MapCorrection();
  };
  BackgroundAdjustment adjustment(Worker::kThread);
  adjustment.Begin(MapOf(2), 0, until_stopped);
  while (!begun) std::this_thread::yield();
  EXPECT_FALSE(adjustment.TakeReady());
  adjustment.GiveUp();
  EXPECT_FALSE(adjustment.Running());
  EXPECT_FALSE(adjustment.TakeDue(0));
}

TEST(BackgroundAdjustment, DoesNotWaitForOneThatIsSlowToStop) {
  for (const Worker worker : {Worker::kThread, Worker::kThreadOfLowPriority}) {
    std::latch begun(1), may_end(1);
    std::atomic<bool> ended = false;
    const auto deaf = [&](const Map&, const StopCheck&) {
      begun.count_down();
      may_end.wait();
      ended = true;
      return MapCorrection();
    };
    {
      BackgroundAdjustment adjustment(worker);
      adjustment.Begin(MapOf(2), 0, deaf);
      begun.wait();
      adjustment.Begin(MapOf(3), 10, CountKeyFrames);
      EXPECT_EQ(Told(adjustment.TakeDue(10)), 3);
      adjustment.Begin(MapOf(4), 20, CountKeyFrames);
      adjustment.GiveUp();
      EXPECT_FALSE(adjustment.Running());
      adjustment.Begin(MapOf(5), 30, CountKeyFrames);
      EXPECT_EQ(Told(adjustment.TakeDue(30)), 5);
      EXPECT_FALSE(ended);
      may_end.count_down();
    }
    EXPECT_TRUE(ended) << "what the computation uses may go after the adjustment";
  }
}

TEST(BackgroundAdjustment, TellsOneThatGivesWayToStop) {
  std::promise<void> stopped;
  const auto until_stopped = [&](const Map&, const StopCheck& stop) {
    while (!stop()) std::this_thread::yield();
    stopped.set_value();
    return MapCorrection();
  };
  BackgroundAdjustment adjustment(Worker::kThread);
  adjustment.Begin(MapOf(2), 0, until_stopped);
  adjustment.Begin(MapOf(3), 10, CountKeyFrames);
  stopped.get_future().wait();
  EXPECT_EQ(Told(adjustment.TakeDue(10)), 3);
}

TEST(BackgroundAdjustment, IsTakenWhenItIsReady) {
  BackgroundAdjustment adjustment(Worker::kThread);
  adjustment.Begin(MapOf(3), 1000, CountKeyFrames);
  std::optional<BackgroundAdjustment::Result> result;
  while (!result) result = adjustment.TakeReady();
  EXPECT_EQ(Told(result), 3);
  EXPECT_FALSE(adjustment.TakeReady());
}

TEST(BackgroundAdjustment, IsWaitedForAtTheEndUnlessStopped) {
  const auto slowly = [](const Map& map, const StopCheck& stop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return CountKeyFrames(map, stop);
  };
  const auto never = [] { return false; };
  const auto at_once = [] { return true; };
  for (const Worker worker : kWorkers) {
    std::latch may_end(1);
    BackgroundAdjustment adjustment(worker);
    EXPECT_FALSE(adjustment.TakeAtEnd(never));
    adjustment.Begin(MapOf(3), 1000, slowly);
    EXPECT_EQ(Told(adjustment.TakeAtEnd(never)), 3);
    EXPECT_FALSE(adjustment.Running());
    adjustment.Begin(MapOf(4), 1000, [&](const Map& map, const StopCheck& stop) {
      may_end.wait();
      return CountKeyFrames(map, stop);
    });
    EXPECT_FALSE(adjustment.TakeAtEnd(at_once)) << "one that is not ready is not waited for";
    EXPECT_FALSE(adjustment.Running());
    may_end.count_down();
  }
}

TEST(BackgroundAdjustment, IsTakenWhenItIsReadyThoughTheRunIsStopped) {
  BackgroundAdjustment adjustment(Worker::kThread);
  std::optional<BackgroundAdjustment::Result> result;
  for (std::chrono::milliseconds time(1); !result; time *= 2) {  // until it is ready in that time
    adjustment.Begin(MapOf(3), 1000, CountKeyFrames);
    std::this_thread::sleep_for(time);
    result = adjustment.TakeAtEnd([] { return true; });
  }
  EXPECT_EQ(Told(result), 3);
}

// A computation in the caller's thread ends when the run is stopped.
TEST(BackgroundAdjustment, AtTheEndTheCallersThreadStops) {
  int asked = 0;
  BackgroundAdjustment adjustment(Worker::kCaller);
  adjustment.Begin(MapOf(3), 1000, [](const Map&, const StopCheck& stop) {
    while (!stop()) continue;
    return MapCorrection();
  });
  const auto result = adjustment.TakeAtEnd([&] { return ++asked > 3; });
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->correction.empty());
}

TEST(BackgroundAdjustment, TakingRethrowsWhatTheComputationThrew) {
  for (const Worker worker : kWorkers) {
    BackgroundAdjustment adjustment(worker);
    adjustment.Begin(MapOf(2), 0, [](const Map&, const StopCheck&) -> MapCorrection {
      throw std::runtime_error("no memory");
    });
    EXPECT_THROW(adjustment.TakeDue(0), std::runtime_error);
    EXPECT_FALSE(adjustment.Running());
  }
}

TEST(AdjustmentDelay, GrowsWithTheMap) {
  EXPECT_GT(AdjustmentDelay(MapOf(2)), 0);
  EXPECT_GT(AdjustmentDelay(MapOf(12)), AdjustmentDelay(MapOf(2)));
}

// A map that grows by keyframes placed beside their parents, as the tracker hands them over.
class GrowingMap {
 public:
  void Add() {
    const KeyFrameId id = map_.NextKeyFrameId();
    const KeyFrameId parent{id.value - 1};
    const Rigid3 pose = PoseOf(id);
    Rng rng(5, "growing_map", static_cast<std::uint64_t>(id.value));
    const NewKeyFrame added{
        {id, parent, MakeFrame(FrameId{id.value}, pose, Sense(world_, pose, {}, rng))},
        {},
        {pose * Inverse(PoseOf(parent)), 1}};
    mapper_.Add(map_, SettledIn(map_, added), {});
  }
  // Bends the map: each keyframe is turned and shifted a little more than the one before.
  MapCorrection Bend() const {
    MapCorrection correction;
    for (const auto& [id, keyframe] : map_.keyframes()) {
      const double k = static_cast<double>(keyframe.number);
      Vector6d twist;
      twist << 0.0005 * k, -0.001 * k, 0, 0.002 * k, 0, 0.001 * k;
      const Rigid3& before = keyframe.frame.cam_from_world;
      correction.keyframes[id] = {before, ExpSe3(twist) * before};
    }
    return correction;
  }
  void Apply(const MapCorrection& correction) { map_.Apply(RebaseCorrection(correction, map_)); }
  const Map& map() const { return map_; }

 private:
  static Rigid3 PoseOf(KeyFrameId id) { return PoseOnPath(static_cast<int>(3 * id.value)); }

  SyntheticWorld world_ = MakeSyntheticWorld(250, 50);
  LocalMapper mapper_{world_.Imaging(), {}, {}};
  Map map_;
};

// The map that takes the correction late is adjusted with the next keyframe; then its newest
// keyframes stand to one another as in the map that took it at once, and the whole where the
// correction says.
TEST(BackgroundAdjustment, TearsNothingHoweverLateItTakesEffect) {
  constexpr int kBefore = 12;
  constexpr int kLatest = 50;
  GrowingMap begun;
  for (int k = 0; k < kBefore; ++k) begun.Add();
  const MapCorrection correction = begun.Bend();
  const auto grown = [&](int delay) {
    GrowingMap map = begun;
    for (int k = 0; k <= kLatest; ++k) {
      if (k == delay) map.Apply(correction);
      map.Add();
    }
    map.map().CheckInvariants();
    return map;
  };
  const GrowingMap at_once = grown(0);
  const KeyFrameId newest = at_once.map().keyframes().rbegin()->first;
  for (const int delay : {1, 5, 20, 50}) {
    const GrowingMap late = grown(delay);
    for (std::int64_t back = 0; back < 3; ++back) {
      const KeyFrameId id{newest.value - back};
      const Rigid3 a = at_once.map().PoseOf(id);
      const Rigid3 b = late.map().PoseOf(id);
      EXPECT_LT(CentreDistance(a, b), 0.02) << delay << " " << back;
      EXPECT_LT(LogSe3(a * Inverse(b)).head<3>().norm(), 0.006) << delay << " " << back;
    }
    const KeyFrameId parent{newest.value - 1};
    const Rigid3 motion_at_once =
        at_once.map().PoseOf(newest) * Inverse(at_once.map().PoseOf(parent));
    const Rigid3 motion_late = late.map().PoseOf(newest) * Inverse(late.map().PoseOf(parent));
    EXPECT_LT(LogSe3(motion_at_once * Inverse(motion_late)).norm(), 0.006) << delay;
  }
}

}  // namespace
}  // namespace plumbline
