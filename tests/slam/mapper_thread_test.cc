// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/mapper_thread.h"

#include "plumbline/features/single_precision.h"

#include "tests/support/initial_map_of.h"
#include "tests/support/synthetic_run.h"
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

SlamOptions WithLag(int lag, RunMode mode = RunMode::kInline) {
  SlamOptions options;
  options.slam.lag = lag;
  options.slam.mode = mode;
  return options;
}

NewKeyFrame KeyFrameAt(const SyntheticWorld& world, std::int64_t id, std::int64_t parent) {
  Rng rng(1, "keyframe", static_cast<std::uint64_t>(id));
  const Rigid3 pose = PoseOnPath(static_cast<int>(4 * id));
  const Rigid3 parent_pose = PoseOnPath(static_cast<int>(4 * parent));
  return {{KeyFrameId{id},
           KeyFrameId{parent},
           MakeFrame(FrameId{id}, pose, Sense(world, pose, {}, rng))},
          {},
          {pose * Inverse(parent_pose), 1}};
}

TEST(MapperThread, TheFirstKeyFrameTakesEffectAtOnce) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(5));
  EXPECT_EQ(stage.SnapshotFor(0), nullptr);
  EXPECT_TRUE(stage.maps().empty());
  stage.Submit(3, KeyFrameAt(world, 0, -1), true);
  const auto snapshot = stage.SnapshotFor(3);
  ASSERT_NE(snapshot, nullptr);
  EXPECT_EQ(snapshot->centre, KeyFrameId{0});
  EXPECT_GT(snapshot->points.size(), 50U);
  EXPECT_FALSE(stage.TakeTimes().empty());
  EXPECT_TRUE(stage.TakeTimes().empty());
}

TEST(MapperThread, AMapThatBeginsWithSeveralKeyFramesTakesEffectAtOnce) {
  const SyntheticWorld world = MakeMonocularWorld(300, 60);
  const InitialMap initial = InitialMapOf(world, {0, 8, 16});
  MapperThread stage(world.Imaging(), WithLag(5));
  stage.Submit(16, MakeInitialMapEdit(initial, world.Imaging(), Rigid3{}, KeyFrameId{0}));
  const auto snapshot = stage.SnapshotFor(16);
  ASSERT_NE(snapshot, nullptr);
  EXPECT_EQ(snapshot->centre, KeyFrameId{2});
  EXPECT_EQ(snapshot->cam_from_world.size(), 3U);
  EXPECT_EQ(snapshot->reference->frame.id, FrameId{16});
  ASSERT_EQ(stage.maps().size(), 1U);
  stage.maps().at(MapId{0}).CheckInvariants();
}

TEST(MapperThread, ANewMapTakesTheLensOfTheMapBefore) {
  const SyntheticWorld world = MakeMonocularWorld(300, 60);
  const LensCorrection lens(world.camera, 2);
  Atlas atlas;
  atlas.Start().Apply({edit::CorrectFeatures{{{}, lens}}});
  MapperThread stage(world.Imaging(), WithLag(5));
  stage.Continue(std::move(atlas), {});
  const InitialMap initial = InitialMapOf(world, {0, 8, 16});
  stage.Submit(16, MakeInitialMapEdit(initial, world.Imaging(), Rigid3{}, KeyFrameId{0}));
  const auto snapshot = stage.SnapshotFor(16);
  ASSERT_NE(snapshot, nullptr);
  EXPECT_EQ(snapshot->map, MapId{1});
  EXPECT_EQ(snapshot->correction.lens, lens);
  EXPECT_EQ(snapshot->reference->frame.indexed->correction.lens, lens);
  Atlas copy = stage.atlas();
  stage.MoveFirstKeyFramesBack(copy);
  EXPECT_EQ(LogSe3(copy.Find(MapId{1})->PoseOf(KeyFrameId{0})).norm(), 0);
  stage.Finish();
  EXPECT_EQ(LogSe3(stage.maps().at(MapId{1}).PoseOf(KeyFrameId{0})).norm(), 0);
}

TEST(MapperThread, OthersTakeEffectAfterTheLag) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  for (const int lag : {0, 1, 4}) {
    MapperThread stage(world.Imaging(), WithLag(lag));
    stage.Submit(0, KeyFrameAt(world, 0, -1), true);
    stage.Submit(10, KeyFrameAt(world, 1, 0), false);
    stage.Submit(11, KeyFrameAt(world, 2, 1), false);
    EXPECT_EQ(stage.SnapshotFor(10 + lag)->centre, KeyFrameId{0}) << lag;
    EXPECT_EQ(stage.SnapshotFor(10 + lag + 1)->centre, KeyFrameId{1}) << lag;
    EXPECT_EQ(stage.SnapshotFor(10 + lag + 2)->centre, KeyFrameId{2}) << lag;
  }
}

TEST(MapperThread, TheResultDoesNotDependOnWhenItIsAsked) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread asked(world.Imaging(), WithLag(1));
  MapperThread not_asked(world.Imaging(), WithLag(1));
  for (std::int64_t k = 0; k < 5; ++k) {
    asked.Submit(2 * k, KeyFrameAt(world, k, k - 1), k == 0);
    asked.SnapshotFor(2 * k + 1);
    not_asked.Submit(2 * k, KeyFrameAt(world, k, k - 1), k == 0);
  }
  asked.Finish();
  not_asked.Finish();
  const auto& a = asked.maps().rbegin()->second.points();
  const auto& b = not_asked.maps().rbegin()->second.points();
  ASSERT_EQ(a.size(), b.size());
  for (auto i = a.begin(), j = b.begin(); i != a.end(); ++i, ++j) {
    EXPECT_EQ(i->second.position, j->second.position);
  }
}

TEST(MapperThread, FinishDoesWhatIsLeft) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(50));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  stage.Submit(1, KeyFrameAt(world, 1, 0), false);
  EXPECT_EQ(stage.SnapshotFor(2)->centre, KeyFrameId{0});
  EXPECT_EQ(stage.maps().rbegin()->second.keyframes().size(), 1U);
  stage.Finish();
  EXPECT_EQ(stage.maps().rbegin()->second.keyframes().size(), 2U);
}

TEST(MapperThread, ANewMapBeginsAfterTheOldOneIsComplete) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(50));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  stage.Submit(1, KeyFrameAt(world, 1, 0), false);
  stage.Submit(2, KeyFrameAt(world, 2, -1), true);
  EXPECT_EQ(stage.SnapshotFor(3)->centre, KeyFrameId{2});
  ASSERT_EQ(stage.maps().size(), 2U);
  EXPECT_EQ(stage.maps().at(MapId{0}).id(), MapId{0});
  EXPECT_EQ(stage.maps().at(MapId{1}).id(), MapId{1});
  EXPECT_EQ(stage.maps().at(MapId{0}).keyframes().size(), 2U);
  EXPECT_EQ(stage.maps().at(MapId{1}).keyframes().size(), 1U);
}

// The features as a lens shows them that a correction of `border_px` would take away.
std::shared_ptr<const FrameFeatures> ThroughALens(
    const RectifiedCamera& camera,
    double border_px,
    const std::shared_ptr<const FrameFeatures>& indexed) {
  Features displaced = indexed->features;
  Correct({{}, {camera, border_px}}, {}, displaced);
  RoundToSinglePrecision(displaced);
  return IndexFeatures(camera, std::move(displaced));
}

constexpr double kBorderPx = 5;  // of the lens below, where the calibration has none

// A map of a single camera with 17 keyframes through a lens that is learned beside mapping, which
// begins with the 16th and is not due yet.
std::unique_ptr<MapperThread> MapperThatLearnsTheLens(const SyntheticWorld& world,
                                                      const SlamOptions& options) {
  std::vector<int> path_frames;
  for (int k = 0; k < 16; ++k) path_frames.push_back(4 * k);
  InitialMap initial = InitialMapOf(world, path_frames);
  for (auto& view : initial.views) {
    view.frame.indexed = ThroughALens(world.camera, kBorderPx, view.frame.indexed);
  }
  auto stage = std::make_unique<MapperThread>(world.Imaging(), options);
  stage->Submit(60, MakeInitialMapEdit(initial, world.Imaging(), Rigid3{}, KeyFrameId{0}));
  Frame frame;
  frame.id = FrameId{64};
  frame.cam_from_world = InMapUnit(PoseOnPath(64));
  frame.indexed = ThroughALens(world.camera, kBorderPx, MonocularFrame(world, 64).indexed);
  frame.points.resize(frame.features().points.size());
  const Rigid3 from_parent = frame.cam_from_world * Inverse(InMapUnit(PoseOnPath(60)));
  stage->Submit(64, {{KeyFrameId{16}, KeyFrameId{15}, frame}, {}, {from_parent, 1}}, false);
  return stage;
}

// A correction of the whole map is due, but no task came that would have applied it.
TEST(MapperThread, ALookAtTheMapsDoesNotHastenACorrection) {
  const SyntheticWorld world = MakeMonocularWorld(400, 0);
  const std::unique_ptr<MapperThread> learning = MapperThatLearnsTheLens(world, WithLag(1));
  MapperThread& stage = *learning;
  constexpr std::int64_t kLongAfter = 1000;
  std::optional<double> seen;
  stage.Submit(kLongAfter,
               MapReader{[&](const Atlas& atlas, const LocalMapper&, const PlaceRecognition&) {
                 seen = atlas.active().correction().lens.border_px();
               }});
  stage.WaitUntilDone();
  EXPECT_EQ(seen, 0);
  EXPECT_EQ(stage.maps().at(MapId{0}).correction().lens.border_px(), 0);
  stage.Submit(kLongAfter, UpdateLocalMapRequest{MapId{0}, {}, {}});
  stage.WaitUntilDone();
  EXPECT_NEAR(stage.maps().at(MapId{0}).correction().lens.border_px(), kBorderPx, 2);
}

// Returns the lens that a map has at the end, if the adjustment at the end is for maps of so many
// keyframes, and all further work is stopped or not.
double LensAtTheEnd(int most_keyframes, bool stopped) {
  const SyntheticWorld world = MakeMonocularWorld(400, 0);
  SlamOptions options = WithLag(1);
  options.mapping.final_adjustment_keyframes = most_keyframes;
  const std::unique_ptr<MapperThread> stage = MapperThatLearnsTheLens(world, options);
  stage->Finish([&] { return stopped; });
  stage->maps().at(MapId{0}).CheckInvariants();
  EXPECT_EQ(LogSe3(stage->maps().at(MapId{0}).PoseOf(KeyFrameId{0})).norm(), 0);
  return stage->maps().at(MapId{0}).correction().lens.border_px();
}

TEST(MapperThread, WhatIsLearnedIsNotLostWhereTheMapIsTooLargeForTheEnd) {
  EXPECT_NEAR(LensAtTheEnd(1000, false), kBorderPx, 2);
  EXPECT_NEAR(LensAtTheEnd(4, false), kBorderPx, 2);
  EXPECT_EQ(LensAtTheEnd(4, true), 0) << "a stop does not wait";
  EXPECT_EQ(LensAtTheEnd(0, false), 0) << "the run ends at once";
}

TEST(MapperThread, OneCameraHasNoTimeOfCalibratingAPair) {
  const SyntheticWorld world = MakeMonocularWorld(400, 0);
  const std::unique_ptr<MapperThread> learning = MapperThatLearnsTheLens(world, WithLag(1));
  learning->WaitUntilDone();
  std::set<std::string> steps;
  for (const MappingStep& step : learning->TakeTimes()) steps.insert(step.name);
  EXPECT_TRUE(steps.contains("adjust"));
  EXPECT_FALSE(steps.contains("calibrate"));
}

class MapperWithThread : public ::testing::TestWithParam<RunMode> {};
INSTANTIATE_TEST_SUITE_P(Modes,
                         MapperWithThread,
                         ::testing::Values(RunMode::kLockstep, RunMode::kLive),
                         [](const auto& mode) { return std::string(NameOf(mode.param)); });

TEST_P(MapperWithThread, WaitsForTheFirstKeyFrameOfAMap) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(5, GetParam()));
  EXPECT_EQ(stage.SnapshotFor(0), nullptr);
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  EXPECT_EQ(stage.SnapshotFor(1)->centre, KeyFrameId{0});
  stage.Submit(1, KeyFrameAt(world, 1, 0), false);
  stage.Submit(2, KeyFrameAt(world, 2, -1), true);
  EXPECT_EQ(stage.SnapshotFor(3)->centre, KeyFrameId{2});
  stage.Finish();
  ASSERT_EQ(stage.maps().size(), 2U);
  EXPECT_EQ(stage.maps().at(MapId{0}).keyframes().size(), 2U);
}

TEST_P(MapperWithThread, ShowsMapsOnlyWhenTheyAreComplete) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(0, GetParam()));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  for (std::int64_t k = 1; k < 4; ++k) stage.Submit(k, KeyFrameAt(world, k, k - 1), false);
  // The thread may be done already.
  try {
    EXPECT_EQ(stage.maps().rbegin()->second.keyframes().size(), 4U);
  } catch (const BugError&) {
  }
  stage.Finish();
  EXPECT_EQ(stage.maps().rbegin()->second.keyframes().size(), 4U);
  stage.maps().rbegin()->second.CheckInvariants();
}

TEST_P(MapperWithThread, RethrowsWhatMappingThrew) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(0, GetParam()));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  stage.Submit(1, KeyFrameAt(world, 0, -1), false);  // there already
  EXPECT_THROW(stage.Finish(), BugError);
  EXPECT_THROW(stage.Finish(), BugError);
}

TEST_P(MapperWithThread, AfterAFailureTheMapsAreWhatWasDone) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(0, GetParam()));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  stage.Submit(1, KeyFrameAt(world, 1, 0), false);
  stage.Submit(2, KeyFrameAt(world, 1, 0), false);  // there already
  stage.Submit(3, KeyFrameAt(world, 2, 1), false);
  EXPECT_THROW(stage.Finish(), BugError);
  ASSERT_EQ(stage.maps().size(), 1U);
  EXPECT_EQ(stage.maps().at(MapId{0}).keyframes().size(), 2U);
  stage.maps().at(MapId{0}).CheckInvariants();
}

TEST_P(MapperWithThread, EndsWithWorkLeft) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(0, GetParam()));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  for (std::int64_t k = 1; k < 8; ++k) stage.Submit(k, KeyFrameAt(world, k, k - 1), false);
}

TEST(MapperThread, InLockstepASnapshotIsNotNewerThanItsFrameMayKnow) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(1, RunMode::kLockstep));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  stage.Submit(10, KeyFrameAt(world, 1, 0), false);
  stage.Submit(11, KeyFrameAt(world, 2, 1), false);
  // Long done, but not due.
  while (stage.Waiting() > 0) std::this_thread::yield();
  EXPECT_EQ(stage.SnapshotFor(11)->centre, KeyFrameId{0});
  EXPECT_EQ(stage.SnapshotFor(12)->centre, KeyFrameId{1});
  EXPECT_EQ(stage.SnapshotFor(20)->centre, KeyFrameId{2});
}

TEST(MapperThread, LiveTheNewestSnapshotCounts) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  MapperThread stage(world.Imaging(), WithLag(50, RunMode::kLive));
  stage.Submit(0, KeyFrameAt(world, 0, -1), true);
  stage.Submit(1, KeyFrameAt(world, 1, 0), false);
  stage.Finish();
  EXPECT_EQ(stage.SnapshotFor(1)->centre, KeyFrameId{1});
}

// A live stage whose keyframes are mapped when the test says so.
class MapperStepByStep : public ::testing::Test {
 protected:
  SyntheticWorld world_ = MakeSyntheticWorld(200, 40);
  MapperThread stage_{world_.Imaging(), WithLag(1, RunMode::kLive), {.threads = false}};
};

TEST_F(MapperStepByStep, KeyFramesThatWaitAreTrackedAgainstAtOnce) {
  stage_.Submit(0, KeyFrameAt(world_, 0, -1), true);
  EXPECT_EQ(stage_.SnapshotFor(1)->centre, KeyFrameId{0});
  EXPECT_EQ(stage_.EarlierSnapshot(), nullptr);
  stage_.Submit(1, KeyFrameAt(world_, 1, 0), false);
  stage_.Submit(2, KeyFrameAt(world_, 2, 1), false);
  EXPECT_EQ(stage_.Waiting(), 2U);
  const auto ahead = stage_.SnapshotFor(3);
  EXPECT_EQ(ahead->centre, KeyFrameId{2});
  EXPECT_EQ(ahead->cam_from_world.size(), 3U);
  EXPECT_EQ(stage_.SnapshotFor(4), ahead);  // not made anew
  EXPECT_TRUE(stage_.WorkOnce());
  EXPECT_TRUE(stage_.WorkOnce());
  EXPECT_FALSE(stage_.WorkOnce());
  const auto mapped = stage_.SnapshotFor(5);
  EXPECT_EQ(mapped->centre, KeyFrameId{2});
  EXPECT_NE(mapped, ahead);
  for (const SnapshotPoint& point : mapped->points) EXPECT_LT(point.id.value, 100'000);
}

TEST_F(MapperStepByStep, WhereTooManyWaitTheLeastInformativeIsGivenUp) {
  stage_.Submit(0, KeyFrameAt(world_, 0, -1), true);
  const auto known = stage_.SnapshotFor(1);
  for (std::int64_t k = 1; k <= 4; ++k) {
    NewKeyFrame added = KeyFrameAt(world_, k, k - 1);
    if (k == 3) {  // shows nothing that is new
      for (PointId& id : added.keyframe.frame.points) id = known->points.front().id;
      for (LineId& id : added.keyframe.frame.lines) id = known->lines.front().id;
    }
    EXPECT_FALSE(stage_.Submit(k, added, false)) << k;
  }
  const auto gone = stage_.Submit(5, KeyFrameAt(world_, 5, 4), false);
  ASSERT_TRUE(gone);
  EXPECT_EQ(gone->id, KeyFrameId{3});
  EXPECT_EQ(gone->frame, FrameId{3});
  EXPECT_EQ(gone->parent, KeyFrameId{2});
  EXPECT_EQ(stage_.Waiting(), MapperThread::kMaxWaiting);
  const auto ahead = stage_.SnapshotFor(6);
  EXPECT_EQ(ahead->centre, KeyFrameId{5});
  EXPECT_FALSE(ahead->cam_from_world.contains(KeyFrameId{3}));
  stage_.Finish();
  const Map& map = stage_.maps().rbegin()->second;
  map.CheckInvariants();
  EXPECT_EQ(map.Find(KeyFrameId{3}), nullptr);
  EXPECT_EQ(map.Find(KeyFrameId{4})->parent, KeyFrameId{2});
}

TEST_F(MapperStepByStep, EarlierSnapshotsAreOfTheMapInUse) {
  stage_.Submit(0, KeyFrameAt(world_, 0, -1), true);
  for (std::int64_t k = 1; k <= 3; ++k) {
    stage_.SnapshotFor(k);
    stage_.Submit(k, KeyFrameAt(world_, k, k - 1), false);
    stage_.WorkOnce();
  }
  EXPECT_EQ(stage_.SnapshotFor(4)->centre, KeyFrameId{3});
  for (const std::int64_t k : {2, 1, 0, 2}) EXPECT_EQ(stage_.EarlierSnapshot()->centre.value, k);
  stage_.Submit(4, KeyFrameAt(world_, 4, -1), true);
  EXPECT_EQ(stage_.SnapshotFor(4)->centre, KeyFrameId{4});
  EXPECT_EQ(stage_.EarlierSnapshot(), nullptr);
}

// A camera that is only localized is found in another map without a SwitchMap.
TEST_F(MapperStepByStep, EarlierSnapshotsAreOfTheMapWhereTheCameraIsFound) {
  stage_.Submit(0, KeyFrameAt(world_, 0, -1), true);
  for (std::int64_t k = 1; k <= 2; ++k) {
    stage_.SnapshotFor(k);
    stage_.Submit(k, KeyFrameAt(world_, k, k - 1), false);
    stage_.WorkOnce();
  }
  const auto newest = stage_.SnapshotFor(3);
  stage_.Use(newest);
  EXPECT_NE(stage_.EarlierSnapshot(), nullptr);
  auto elsewhere = std::make_shared<MapSnapshot>(*newest);
  elsewhere->map = MapId{5};
  stage_.Use(elsewhere);
  EXPECT_EQ(stage_.SnapshotFor(4)->map, MapId{5});
  EXPECT_EQ(stage_.EarlierSnapshot(), nullptr);
}

// A camera that is only localized tells what it sees; before mapping has looked at that, it is lost
// and found in another map.
TEST_F(MapperStepByStep, ASightingInAMapThatIsNotInUseAnyMoreChangesNothing) {
  stage_.Submit(0, KeyFrameAt(world_, 0, -1), true);
  const auto snapshot = stage_.SnapshotFor(1);
  ASSERT_FALSE(snapshot->points.empty());
  const UpdateLocalMapRequest sighting{MapId{0}, {snapshot->points.front().id}, {}};
  stage_.Submit(1, sighting);
  auto elsewhere = std::make_shared<MapSnapshot>(*snapshot);
  elsewhere->map = MapId{5};
  stage_.Use(elsewhere);
  EXPECT_TRUE(stage_.WorkOnce());
  EXPECT_EQ(stage_.SnapshotFor(2)->map, MapId{5});

  stage_.Use(snapshot);
  stage_.Submit(3, sighting);
  EXPECT_TRUE(stage_.WorkOnce());
  EXPECT_EQ(stage_.SnapshotFor(4)->map, MapId{0});
}

// Returns how often the adjustment at the end of a live run asks whether to stop, which it does at
// least once in each of its rounds. `shed` is what was shed of the last task before the end.
int StepsAtTheEnd(LoadLevel shed) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 40);
  SlamOptions options = WithLag(1, RunMode::kLive);
  options.mapping.ba.rounds = 20;
  options.mapping.ba.max_iterations = 1;
  options.mapping.ba.rejection_tolerance = 0;  // no round is left out
  MapperThread stage(world.Imaging(), options, {.threads = false});
  for (std::int64_t k = 0; k < 4; ++k) {
    stage.Submit(k, KeyFrameAt(world, k, k - 1), k == 0);
    EXPECT_TRUE(stage.WorkOnce());
  }
  stage.Lighten(shed);
  stage.Submit(4, MapReader{[](const Atlas&, const LocalMapper&, const PlaceRecognition&) {}});
  EXPECT_TRUE(stage.WorkOnce());
  int steps = 0;
  stage.Finish([&] {
    ++steps;
    return false;
  });
  return steps;
}

TEST(MapperThread, LiveNothingIsShedOfTheAdjustmentAtTheEnd) {
  EXPECT_EQ(StepsAtTheEnd(LoadLevel::kMapping), StepsAtTheEnd(LoadLevel::kNothing));
}

// Poses of a run over the synthetic world, as first reported.
std::vector<Rigid3> Poses(int lag, RunMode mode = RunMode::kInline) {
  SyntheticRun run(MakeSyntheticWorld(300, 60), WithLag(lag, mode));
  std::vector<Rigid3> poses;
  for (int i = 0; i < 25; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), {});
    EXPECT_TRUE(result.cam_from_world) << "frame " << i;
    poses.push_back(result.cam_from_world.value_or(Rigid3{}));
  }
  run.Finish();
  run.maps().rbegin()->second.CheckInvariants();
  return poses;
}

bool SameBits(const std::vector<Rigid3>& a, const std::vector<Rigid3>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.rotation.coeffs() == y.rotation.coeffs() && x.translation == y.translation;
  });
}

TEST(TrackingAndMapping, RepeatToTheLastBit) { EXPECT_TRUE(SameBits(Poses(1), Poses(1))); }

TEST(TrackingAndMapping, InLockstepAreTheSameToTheLastBit) {
  for (const int lag : {0, 1, 3}) {
    EXPECT_TRUE(SameBits(Poses(lag), Poses(lag, RunMode::kLockstep))) << lag;
  }
}

TEST(TrackingAndMapping, LiveFollowToo) {
  const std::vector<Rigid3> poses = Poses(1, RunMode::kLive);
  for (int i = 0; i < 25; ++i) {
    EXPECT_LT(CentreDistance(poses[static_cast<std::size_t>(i)], PoseOnPath(i)), 0.03);
  }
}

TEST(TrackingAndMapping, TheLagIsPartOfTheAlgorithm) {
  const std::vector<Rigid3> at_once = Poses(0);
  const std::vector<Rigid3> later = Poses(3);
  EXPECT_FALSE(SameBits(at_once, later));
  for (int i = 0; i < 25; ++i) {
    EXPECT_LT(CentreDistance(at_once[static_cast<std::size_t>(i)], PoseOnPath(i)), 0.03);
    EXPECT_LT(CentreDistance(later[static_cast<std::size_t>(i)], PoseOnPath(i)), 0.03);
  }
}

// Tracks a single camera whose lens is not quite that of the calibration, at first with a map that
// knows nothing of it.
TEST(TrackingAndMapping, LearnTheLensOfOneCameraWhileTheMapGrows) {
  constexpr double kBorder = 5;
  constexpr int kFrames = 300;
  const SyntheticWorld world = MakeMonocularWorld(800, 0);
  SyntheticRun run(world);
  InitialMap initial = InitialMapOf(world, {0, 8, 16});
  for (auto& view : initial.views) {
    view.frame.indexed = ThroughALens(world.camera, kBorder, view.frame.indexed);
  }
  const Rigid3 motion = InMapUnit(PoseOnPath(16)) * Inverse(InMapUnit(PoseOnPath(15)));
  run.Start(initial, LogSe3(motion) / 0.05);
  std::optional<int> learned_at;
  std::optional<Rigid3> last;
  for (int i = 17; i < kFrames; ++i) {
    Rng rng(1, "lens", static_cast<std::uint64_t>(i));
    SyntheticFrame sensed = Sense(world, PoseOnPath(i), {.depth = false, .noise = 0.1}, rng);
    sensed.indexed = ThroughALens(world.camera, kBorder, sensed.indexed);
    const TrackingResult result = run.Step(sensed);
    ASSERT_TRUE(result.cam_from_world) << "frame " << i;
    const LensCorrection& lens = run.maps().rbegin()->second.correction().lens;
    EXPECT_EQ(result.frame.indexed->correction.lens, lens) << "frame " << i;
    if (lens.border_px() != 0 && !learned_at) {
      learned_at = i;
      EXPECT_NEAR(lens.border_px(), kBorder, 1.5);
    }
    // What is learned moves the map behind the camera, and not the camera.
    if (last) {
      EXPECT_LT(CentreDistance(*result.cam_from_world, *last), 0.02) << "frame " << i;
    }
    last = result.cam_from_world;
  }
  ASSERT_TRUE(learned_at);
  const Map& map = run.maps().rbegin()->second;
  const KeyFrameId first = map.keyframes().begin()->first;
  EXPECT_GT(LogSe3(map.PoseOf(first)).norm(), 1e-4) << "the map has moved behind the camera";
  run.Finish();
  EXPECT_EQ(LogSe3(map.PoseOf(first)).norm(), 0) << "the world is the first keyframe's camera";
  map.CheckInvariants();
}

}  // namespace
}  // namespace plumbline
