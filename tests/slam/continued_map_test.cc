// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// Going on in a map of an earlier run.
#include "plumbline/base/error.h"
#include "plumbline/slam/atlas_context.h"
#include "plumbline/slam/system.h"

#include "tests/support/moving_poster.h"
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace continued_map_test {

constexpr int kFrames = 40;  // of the run that makes the map

SlamOptions InMode(RunMode mode) {
  SlamOptions options;
  options.slam.mode = mode;
  return options;
}

SavedAtlas MappedPoster() {
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  const MovingPoster poster;
  for (int i = 0; i < kFrames; ++i) system.Process(poster.Frame(i));
  RunResult result = system.Finish();
  return {std::move(result.atlas), std::move(result.context)};
}

// Frame `first` on of the same poster, in the map.
RunResult GoOn(const SavedAtlas& saved, bool read_only, int first, int last, RunMode mode) {
  System system(MovingPoster::MakeCalibration(), InMode(mode));
  system.Continue(saved, read_only);
  const MovingPoster poster;
  for (int i = first; i < last; ++i) system.Process(poster.Frame(i));
  return system.Finish();
}

int CountTracked(const RunResult& result) {
  int tracked = 0;
  for (const FrameRecord& frame : result.frames) tracked += frame.status == FrameStatus::kTracked;
  return tracked;
}

void ExpectThePosesOfThePoster(const Trajectory& trajectory) {
  for (const StampedPose& pose : trajectory) {
    const double frame =
        1e-9 * static_cast<double>(pose.stamp_ns - MovingPoster::StampNs(0)) / 0.05;
    const Eigen::Vector3d expected(MovingPoster::kStep * frame, 0, 0);
    EXPECT_LT((pose.world_from_camera.translation - expected).norm(), 0.01) << frame;
  }
}

TEST(ContinuedMap, FirstFramesAreLostUntilTheirPlaceIsFound) {
  const RunResult result = GoOn(MappedPoster(), false, 10, 30, RunMode::kInline);
  EXPECT_EQ(result.frames.front().status, FrameStatus::kLost);
  EXPECT_EQ(result.frames.front().reason, "not_relocalized");
  EXPECT_GE(CountTracked(result), 17);
  ExpectThePosesOfThePoster(result.FinalTrajectory(MapId{0}));
  ExpectThePosesOfThePoster(result.CausalTrajectory(MapId{0}));
}

// What is known is not told again.
TEST(ContinuedMap, TellsOnceThatThePlaceWasFound) {
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  system.Continue(MappedPoster(), false);
  const MovingPoster poster;
  for (int i = 10; i < 30; ++i) system.Process(poster.Frame(i));
  MapEventCounts known;
  const MapEvents events = system.EventsSince(known);
  ASSERT_EQ(events.relocalizations.size(), 1U);
  EXPECT_TRUE(system.EventsSince(known).empty());
  const RunResult result = system.Finish();
  ASSERT_EQ(result.events.relocalizations.size(), 1U);
  EXPECT_EQ(events.relocalizations[0].frame, result.events.relocalizations[0].frame);
}

TEST(ContinuedMap, GrowsAndKeepsItsId) {
  const SavedAtlas saved = MappedPoster();
  const KeyFrameId first_new = saved.atlas.NextKeyFrameId();
  const RunResult result = GoOn(saved, false, 20, 75, RunMode::kInline);
  ASSERT_EQ(result.atlas.maps().size(), 1U);
  const Map& map = result.atlas.maps().at(MapId{0});
  map.CheckInvariants();
  EXPECT_GT(map.keyframes().rbegin()->first, first_new);
  EXPECT_EQ(result.MainMap(), MapId{0});
  ExpectThePosesOfThePoster(result.FinalTrajectory(MapId{0}));
  // Own keyframes only.
  const Trajectory keyframes = result.KeyFrameTrajectory(MapId{0});
  ASSERT_FALSE(keyframes.empty());
  EXPECT_LT(keyframes.size(), map.keyframes().size());
  for (const StampedPose& pose : keyframes) EXPECT_GE(pose.stamp_ns, MovingPoster::StampNs(20));
}

TEST(ContinuedMap, ThatIsOnlyReadStaysAsItIs) {
  const SavedAtlas saved = MappedPoster();
  const Map& before = saved.atlas.active();
  const RunResult result = GoOn(saved, true, 5, 35, RunMode::kInline);
  EXPECT_GE(CountTracked(result), 27);
  const Map& after = result.atlas.maps().at(MapId{0});
  EXPECT_EQ(after.version(), before.version());
  EXPECT_EQ(after.keyframes().size(), before.keyframes().size());
  EXPECT_TRUE(result.KeyFrameTrajectory(MapId{0}).empty());
  for (const FrameRecord& frame : result.frames) EXPECT_FALSE(frame.keyframe);
  ExpectThePosesOfThePoster(result.FinalTrajectory(MapId{0}));
}

TEST(ContinuedMap, GivesTheSameInEveryDeterministicMode) {
  const SavedAtlas saved = MappedPoster();
  for (const bool read_only : {false, true}) {
    const auto a = GoOn(saved, read_only, 8, 40, RunMode::kInline);
    const auto b = GoOn(saved, read_only, 8, 40, RunMode::kLockstep);
    const Trajectory of_a = a.FinalTrajectory(MapId{0});
    const Trajectory of_b = b.FinalTrajectory(MapId{0});
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      EXPECT_EQ(of_a[i].stamp_ns, of_b[i].stamp_ns);
      EXPECT_EQ(of_a[i].world_from_camera.translation, of_b[i].world_from_camera.translation);
      EXPECT_EQ(of_a[i].world_from_camera.rotation.coeffs(),
                of_b[i].world_from_camera.rotation.coeffs());
    }
  }
}

TEST(ContinuedMap, ALossInItIsNotTheEnd) {
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  system.Continue(MappedPoster(), true);
  const MovingPoster poster;
  for (int i = 0; i < 10; ++i) system.Process(poster.Frame(i));
  for (int i = 10; i < 25; ++i) system.Process(MovingPoster::BlindFrame(i));
  // Elsewhere in the map.
  int tracked = 0;
  for (int i = 25; i < 40; ++i) {
    tracked += system.Process(poster.Frame(i)).status == FrameStatus::kTracked;
  }
  EXPECT_GE(tracked, 11);
  const RunResult result = system.Finish();
  ExpectThePosesOfThePoster(result.FinalTrajectory(MapId{0}));
}

TEST(ContinuedMap, ThatDoesNotShowTheCamerasPlaceGivesWayToANewOne) {
  SlamOptions options = InMode(RunMode::kInline);
  options.relocalization.patience = 6;
  options.loop.enabled = false;  // or it would be recognized as the same place
  System system(MovingPoster::MakeCalibration(), options);
  system.Continue(MappedPoster(), false);
  const MovingPoster poster;
  for (int i = 0; i < 8; ++i) system.Process(MovingPoster::StrangeFrame(i));
  for (int i = 8; i < 14; ++i) system.Process(poster.Frame(i));
  const RunResult result = system.Finish();
  ASSERT_EQ(result.atlas.maps().size(), 2U);
  EXPECT_EQ(result.MainMap(), MapId{1});
  EXPECT_EQ(result.frames.back().map, MapId{1});
  // No id of the one map is used in the other.
  const Map& old = result.atlas.maps().at(MapId{0});
  const Map& young = result.atlas.maps().at(MapId{1});
  EXPECT_LT(old.keyframes().rbegin()->first, young.keyframes().begin()->first);
  EXPECT_LT(old.points().rbegin()->first, young.points().begin()->first);
}

// The newest map was taken into another one: its id is not given again.
TEST(ContinuedMap, ANewMapGetsAnIdThatNoJoinedOneHad) {
  SavedAtlas saved = MappedPoster();
  saved.atlas.Start();
  saved.atlas.Join(MapId{0}, MapId{1}, Similarity3{});
  saved.atlas.Activate(MapId{0});
  SlamOptions options = InMode(RunMode::kInline);
  options.relocalization.patience = 6;
  options.loop.enabled = false;  // or it would be recognized as the same place
  System system(MovingPoster::MakeCalibration(), options);
  system.Continue(saved, false);
  const MovingPoster poster;
  for (int i = 0; i < 8; ++i) system.Process(MovingPoster::StrangeFrame(i));
  for (int i = 8; i < 14; ++i) system.Process(poster.Frame(i));
  const RunResult result = system.Finish();
  EXPECT_EQ(result.frames.back().map, MapId{2});
  EXPECT_TRUE(result.atlas.maps().contains(MapId{2}));
  EXPECT_EQ(result.FinalTrajectory(MapId{2}).size(), 6U);
}

TEST(ContinuedMap, ThatIsOnlyReadNeverGivesWay) {
  SlamOptions options = InMode(RunMode::kInline);
  options.relocalization.patience = 2;
  System system(MovingPoster::MakeCalibration(), options);
  system.Continue(MappedPoster(), true);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(system.Process(MovingPoster::BlindFrame(i)).status, FrameStatus::kLost);
  }
  EXPECT_FALSE(system.Finish().MainMap());
}

TEST(ContinuedMap, NeedsRelocalization) {
  SlamOptions options;
  options.relocalization.enabled = false;
  System system(MovingPoster::MakeCalibration(), options);
  EXPECT_THROW(system.Continue(MappedPoster(), false), InputError);
}

TEST(ContinuedMap, IsOfTheSameCamera) {
  SavedAtlas saved = MappedPoster();
  saved.context.camera.fx += 1;
  System system(MovingPoster::MakeCalibration(), {});
  try {
    system.Continue(saved, false);
    FAIL() << "another camera";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("fx"));
  }
  // Turned against the left camera in another way it serves all the same.
  saved.context.camera.fx -= 1;
  saved.context.rectified_from_left = ExpSo3({0, 0.1, 0});
  EXPECT_TRUE(System(MovingPoster::MakeCalibration(), {}).Continue(saved, false).empty());
}

TEST(ContinuedMap, TellsWhatIsDifferentInTheFrontEnd) {
  SlamOptions options;
  options.features.line_count = 100;
  System system(MovingPoster::MakeCalibration(), options);
  const std::vector<std::string> notes = system.Continue(MappedPoster(), true);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], testing::HasSubstr("features.line_count"));
}

TEST(ContinuedMap, ThatIsOnlyReadIsCopiedWithWhatItWasMadeWith) {
  const SavedAtlas saved = MappedPoster();
  SlamOptions options = InMode(RunMode::kInline);
  options.features.line_count = 100;
  System system(MovingPoster::MakeCalibration(), options);
  system.Continue(saved, true);
  const MovingPoster poster;
  for (int i = 5; i < 8; ++i) system.Process(poster.Frame(i));
  SavedAtlas copied;
  system.ReadMaps([&copied](const CurrentMaps& maps) { copied = maps.copy(); });
  system.WaitForMapping();
  EXPECT_EQ(copied.context.options_yaml, saved.context.options_yaml);
  EXPECT_EQ(copied.context.sessions.size(), 1U);
  EXPECT_EQ(copied.atlas.active().version(), saved.atlas.active().version());
}

TEST(ContinuedMap, NamesTheSessionsThatMadeIt) {
  const SavedAtlas saved = MappedPoster();
  const auto read = GoOn(saved, true, 5, 10, RunMode::kInline);
  EXPECT_EQ(read.context.sessions.size(), 1U);
  const auto grown = GoOn(saved, false, 20, 70, RunMode::kInline);
  const AtlasContext& context = grown.context;
  ASSERT_EQ(context.sessions.size(), 2U);
  EXPECT_NE(context.sessions[0].uuid, context.sessions[1].uuid);
  EXPECT_EQ(context.maps.at(MapId{0}).uuid, saved.context.maps.at(MapId{0}).uuid);
  const auto& keyframes = grown.atlas.maps().at(MapId{0}).keyframes();
  EXPECT_EQ(keyframes.begin()->second.session, SessionId{0});
  EXPECT_EQ(keyframes.rbegin()->second.session, SessionId{1});
}

}  // namespace continued_map_test
}  // namespace plumbline
