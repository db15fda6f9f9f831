// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/place_recognition.h"

#include "plumbline/map/covisibility.h"

#include "tests/loop_closing/loop_scene.h"
#include "tests/support/synthetic_run.h"
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace place_recognition_test {

constexpr int kRound = 300;  // frames
constexpr int kFrames = kRound + 60;

Rigid3 PoseAt(int frame) {
  return testing::loop_scene_detail::PoseOnCircle(2 * std::numbers::pi * frame / kRound);
}

// Tracking and mapping of a camera that goes round a circle and a bit further.
class Round {
 public:
  explicit Round(RunMode mode = RunMode::kInline, bool loops = true)
      : run_(testing::loop_scene_detail::MakeWorld({}), Options(mode, loops)) {}

  // All frames, of which those from `blind` on show nothing until another map starts.
  void Go(int blind = kFrames) {
    constexpr int kBlindFrames = 12;
    for (int k = 0; k < kFrames; ++k) {
      if (k >= blind && k < blind + kBlindFrames) {
        run_.StepBlind();
        continue;
      }
      const TrackingResult result = run_.Step(PoseAt(k), {});
      if (result.keyframe) frame_of_[result.keyframe->keyframe.id] = k;
    }
    run_.Finish();
  }

  const MapperThread& stage() const { return run_.mapping(); }
  int FrameOf(KeyFrameId id) const { return frame_of_.at(id); }
  const Map& map() const { return stage().atlas().active(); }

  KeyFrameId Newest() const { return map().keyframes().rbegin()->first; }

  // Whether a keyframe of the second round shares landmarks with one of the beginning.
  bool LastShowsWhatFirstShowed() const {
    for (const auto& [id, keyframe] : map().keyframes()) {
      if (FrameOf(id) < kRound) continue;
      for (const auto& other : Covisible(map(), id)) {
        if (FrameOf(other.id) < kFrames - kRound) return true;
      }
    }
    return false;
  }

  // How far the second keyframe is from its true place beside the first [m].
  double ErrorBetween(KeyFrameId first, KeyFrameId id) const {
    const Rigid3 found = map().PoseOf(id) * Inverse(map().PoseOf(first));
    const Rigid3 is = PoseAt(FrameOf(id)) * Inverse(PoseAt(FrameOf(first)));
    return CentreDistance(found, is);
  }

  // The largest error of a keyframe's place beside the oldest one [m].
  double WorstPlace() const {
    const KeyFrameId first = map().keyframes().begin()->first;
    double worst = 0;
    for (const auto& [id, keyframe] : map().keyframes()) {
      worst = std::max(worst, ErrorBetween(first, id));
    }
    return worst;
  }

 private:
  static SlamOptions Options(RunMode mode, bool loops) {
    SlamOptions options;
    options.slam.mode = mode;
    options.loop.enabled = loops;
    options.relocalization.enabled = false;
    options.tracking.new_map_after = 10;
    return options;
  }

  SyntheticRun run_;
  std::map<KeyFrameId, int> frame_of_;
};

TEST(PlaceRecognition, ClosesALoop) {
  Round round;
  round.Go();
  const MapEvents events = round.stage().events();
  ASSERT_FALSE(events.loops.empty());
  EXPECT_TRUE(events.joins.empty());
  MapEventCounts known;
  EXPECT_EQ(round.stage().EventsSince(known).loops.size(), events.loops.size());
  EXPECT_TRUE(round.stage().EventsSince(known).empty());
  known.loops = events.loops.size() - 1;
  const MapEvents last = round.stage().EventsSince(known);
  ASSERT_EQ(last.loops.size(), 1U);
  EXPECT_EQ(last.loops[0].keyframe, events.loops.back().keyframe);
  const Recognition& loop = events.loops.front();
  EXPECT_GT(round.FrameOf(loop.keyframe) - round.FrameOf(loop.older), 250);
  EXPECT_GT(loop.points + loop.lines, 25);
  EXPECT_LT(loop.log10_chance, -8);
  EXPECT_EQ(loop.frame.value, round.FrameOf(loop.keyframe));
  EXPECT_EQ(loop.scale, 1);
  round.map().CheckInvariants();
  // The camera is back where it was, and the map says so.
  EXPECT_LT(round.ErrorBetween(round.map().keyframes().begin()->first, round.Newest()), 0.03);
  EXPECT_TRUE(round.LastShowsWhatFirstShowed());
}

TEST(PlaceRecognition, LeavesLoopsOpenWhereThatIsAsked) {
  Round round(RunMode::kInline, false);
  round.Go();
  EXPECT_TRUE(round.stage().events().loops.empty());
  EXPECT_FALSE(round.LastShowsWhatFirstShowed());
}

TEST(PlaceRecognition, JoinsTheMapThatShowsTheSamePlace) {
  constexpr int kBlind = 150;
  Round round;
  round.Go(kBlind);
  const MapEvents events = round.stage().events();
  ASSERT_EQ(events.joins.size(), 1U);
  MapEventCounts known;
  EXPECT_EQ(round.stage().EventsSince(known).joins.size(), 1U);
  EXPECT_TRUE(round.stage().EventsSince(known).joins.empty());
  const MapJoin& join = events.joins.front();
  EXPECT_EQ(join.kept, MapId{0});
  EXPECT_EQ(join.gone, MapId{1});
  EXPECT_GT(round.FrameOf(join.place.keyframe), kBlind);
  EXPECT_LT(round.FrameOf(join.place.older), kBlind);
  const Atlas& atlas = round.stage().atlas();
  ASSERT_EQ(atlas.maps().size(), 1U);
  EXPECT_EQ(atlas.Current(MapId{1}), MapId{0});
  atlas.active().CheckInvariants();
  EXPECT_LT(round.WorstPlace(), 0.05);
}

TEST(PlaceRecognition, LockstepDoesWhatInlineDoes) {
  Round alone(RunMode::kInline), beside(RunMode::kLockstep);
  alone.Go(150);
  beside.Go(150);
  const Map& a = alone.map();
  const Map& b = beside.map();
  ASSERT_EQ(a.keyframes().size(), b.keyframes().size());
  for (const auto& [id, keyframe] : a.keyframes()) {
    const Rigid3& other = b.Find(id)->frame.cam_from_world;
    EXPECT_EQ(keyframe.frame.cam_from_world.translation, other.translation);
    EXPECT_EQ(keyframe.frame.cam_from_world.rotation.coeffs(), other.rotation.coeffs());
  }
}

// Round a circle with one camera in 24 keyframes and a bit further; the unit of the map at each.
testing::LoopScene YoungMap(const std::function<double(int)>& unit) {
  testing::LoopSceneOptions options;
  options.sensor.depth = false;
  options.keyframes_per_round = 24;
  options.keyframes = 28;
  options.drift = [unit](int keyframe) {
    Similarity3 drift;
    drift.scale = unit(keyframe);
    return drift;
  };
  return testing::MakeLoopScene(options);
}

Atlas AtlasOf(const Map& map) {
  Atlas atlas;
  atlas.Adopt(map);
  atlas.Activate(map.id());
  return atlas;
}

TEST(PlaceRecognition, WithdrawsAYoungMapWhoseUnitRunsAway) {
  for (const double growth : {1.0, 1.3, 5.0, 150.0}) {
    const testing::LoopScene scene =
        YoungMap([&](int keyframe) { return std::pow(growth, keyframe / 24.0); });
    Atlas atlas = AtlasOf(scene.map);
    PlaceRecognition places(scene.Imaging(), {});
    places.Follow(atlas);
    EXPECT_EQ(places.Withdraws(atlas, scene.Newest()), growth > 2) << growth;
    EXPECT_EQ(places.IsWithdrawn(scene.map.id()), growth > 2) << growth;
    if (growth < 2) continue;
    EXPECT_FALSE(places.Withdraws(atlas, scene.Newest()));  // it is already
    EXPECT_EQ(places.Recognize(atlas, scene.Newest()), std::nullopt);
  }
}

// Halfway round, all has another size. The newest keyframe comes once more, and mapping takes it
// in.
TEST(PlaceRecognition, SnapshotsOfAMapThatWasWithdrawnSaySo) {
  for (const double growth : {1.0, 5.0}) {
    const testing::LoopScene scene =
        YoungMap([&](int keyframe) { return keyframe < 14 ? 1 : growth; });
    SlamOptions options;
    options.slam.mode = RunMode::kInline;
    MapperThread stage(scene.Imaging(), options);
    stage.Continue(AtlasOf(scene.map), {});
    KeyFrame keyframe = *scene.map.Find(scene.Newest());
    const KeyFramePose parent = scene.map.PlaceOf(keyframe.parent);
    const RelativePose from_parent{keyframe.frame.cam_from_world * Inverse(parent.cam_from_world),
                                   parent.scale};
    keyframe.id = scene.map.NextKeyFrameId();
    stage.Submit(0, NewKeyFrame{keyframe, {}, from_parent}, false);
    const auto snapshot = stage.SnapshotFor(5);
    ASSERT_NE(snapshot, nullptr);
    EXPECT_EQ(snapshot->withdrawn, growth > 2) << growth;
  }
}

TEST(PlaceRecognition, KnowsTheKeyFramesOfASavedAtlas) {
  Round round;
  round.Go();
  const Atlas& atlas = round.stage().atlas();
  PlaceRecognition places({}, {});
  const KeyFrame& keyframe = std::next(round.map().keyframes().begin(), 2)->second;
  const Features& features = keyframe.frame.features();
  EXPECT_TRUE(places.PlacesOf(atlas, features, 3).empty());
  places.Follow(atlas);
  const auto alike = places.PlacesOf(atlas, features, 3);
  ASSERT_EQ(alike.size(), 3U);
  EXPECT_EQ(alike.front().keyframe, keyframe.id);
  EXPECT_EQ(alike.front().map, &atlas.active());
}

}  // namespace place_recognition_test
}  // namespace plumbline
