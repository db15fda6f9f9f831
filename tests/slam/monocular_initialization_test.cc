// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/monocular_initialization.h"

#include "tests/support/initial_map_of.h"
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

ExtractedFrame MeasuredOf(const InitializationFrame& frame) {
  ExtractedFrame extracted;
  extracted.stamp_ns = frame.stamp_ns;
  extracted.images.left = GrayImage(8, 6);
  extracted.indexed = frame.indexed;
  return extracted;
}

double ErrorMetres(const Rigid3& cam_from_world, FrameId frame) {
  const Rigid3 truth = InMapUnit(PoseOnPath(static_cast<int>(frame.value)));
  return CentreDistance(cam_from_world, truth) * kMapUnit;
}

// Frames 2 to 22 wait; the map is that of frames 10, 14 and 22.
struct WaitingRun {
  SyntheticWorld world = MakeMonocularWorld(500, 80);
  MonocularInitialization start{world.Imaging(), {}};
  Atlas atlas;

  WaitingRun() {
    for (int i = 2; i <= 22; ++i) {
      start.Offer(FrameId{i}, MeasuredOf(MonocularFrame(world, i)));
    }
    const InitialMap initial = InitialMapOf(world, {10, 14, 22});
    const InitialMapEdit initial_map =
        MakeInitialMapEdit(initial, world.Imaging(), Rigid3{}, KeyFrameId{0});
    atlas.Start().Apply(initial_map.edit);
    start.MapStarted(MapId{0}, initial_map);
  }
};

TEST(MonocularInitialization, LocatesTheFramesThatWaited) {
  WaitingRun run;
  const std::vector<EarlierFrame> located = run.start.Locate(run.atlas);
  std::set<FrameId> found;
  for (const EarlierFrame& frame : located) {
    found.insert(frame.id);
    EXPECT_EQ(frame.map, MapId{0});
    // The keyframe that came next; the first for those before it.
    const auto number = frame.id.value;
    EXPECT_EQ(frame.reference, KeyFrameId{number > 14 ? 2 : number > 10 ? 1 : 0});
    EXPECT_GT(frame.counts.inlier_points, 50);
    const Rigid3 pose =
        ComposePose(run.atlas.active().PlaceOf(frame.reference), frame.from_reference);
    EXPECT_LT(ErrorMetres(pose, frame.id), 0.02) << frame.id.value;
  }
  // All but the keyframes, those before the first one included.
  EXPECT_EQ(found.size(), 18U);
  for (const int keyframe : {10, 14, 22}) EXPECT_FALSE(found.contains(FrameId{keyframe}));
  EXPECT_TRUE(run.start.Locate(run.atlas).empty());  // once
}

// What a tracker says of a frame of the path: off by half the way from the reference, as in a
// map whose scale was corrected later.
TrackingResult TrackedOf(const SyntheticWorld& world, int frame, KeyFrameId id, int of_frame) {
  const InitializationFrame seen = MonocularFrame(world, frame);
  TrackingResult result;
  result.frame.id = seen.id;
  result.frame.stamp_ns = seen.stamp_ns;
  result.frame.indexed = seen.indexed;
  result.reference = id;
  if (frame == of_frame) {
    result.keyframe = NewKeyFrame{};
    return result;
  }
  result.from_reference.cam_from_keyframe =
      InMapUnit(PoseOnPath(frame)) * Inverse(InMapUnit(PoseOnPath(of_frame)));
  result.from_reference.cam_from_keyframe.translation *= 0.5;
  return result;
}

// The map begins with frames 10 and 14; frames 15 to 40 are tracked against keyframe 14 up to 21,
// then against 22, the map's third; a fourth, 30, has gone again.
struct YoungRun {
  SyntheticWorld world = MakeMonocularWorld(500, 80);
  MonocularInitialization start{world.Imaging(), {}};
  Atlas atlas;

  YoungRun() {
    atlas.Start().Apply(StartOf({10, 14, 22, 30}).edit);
    atlas.active().Apply({edit::RemoveKeyFrame{KeyFrameId{3}}});
    Begin();
  }

  InitialMapEdit StartOf(const std::vector<int>& frames) const {
    return MakeInitialMapEdit(
        InitialMapOf(world, frames), world.Imaging(), Rigid3{}, KeyFrameId{0});
  }

  void Begin() { start.MapStarted(MapId{0}, StartOf({10, 14})); }

  void Track(int frame) {
    start.Tracked(frame < 22   ? TrackedOf(world, frame, KeyFrameId{1}, 14)
                  : frame < 30 ? TrackedOf(world, frame, KeyFrameId{2}, 22)
                               : TrackedOf(world, frame, KeyFrameId{3}, 30));
  }
};

TEST(MonocularInitialization, LocatesTheFramesTrackedInAYoungMap) {
  YoungRun run;
  for (int i = 15; i <= 40; ++i) run.Track(i);
  std::set<FrameId> found;
  for (const EarlierFrame& frame : run.start.Locate(run.atlas)) {
    found.insert(frame.id);
    EXPECT_NE(run.atlas.active().Find(frame.reference), nullptr);
    const Rigid3 pose =
        ComposePose(run.atlas.active().PlaceOf(frame.reference), frame.from_reference);
    EXPECT_LT(ErrorMetres(pose, frame.id), 0.02) << frame.id.value;
  }
  // All but the keyframe that is left.
  EXPECT_EQ(found.size(), 25U);
  EXPECT_FALSE(found.contains(FrameId{22}));
  EXPECT_TRUE(found.contains(FrameId{30}));
  // It was needed.
  const TrackingResult tracked = TrackedOf(run.world, 21, KeyFrameId{1}, 14);
  EXPECT_GT(
      ErrorMetres(ComposePose(run.atlas.active().PlaceOf(KeyFrameId{1}), tracked.from_reference),
                  FrameId{21}),
      0.06);
}

TEST(MonocularInitialization, AMapIsYoungForSomeKeyFrames) {
  YoungRun run;
  for (int i = 1; i < MonocularInitialization::kYoungKeyFrames; ++i) run.Track(22);
  run.Track(23);
  run.Track(22);
  run.Track(24);
  const std::vector<EarlierFrame> located = run.start.Locate(run.atlas);
  ASSERT_EQ(located.size(), 1U);
  EXPECT_EQ(located[0].id, FrameId{23});
}

TEST(MonocularInitialization, AMapIsYoungUntilItIsLost) {
  YoungRun run;
  run.Track(15);
  run.start.Restart();
  run.Track(16);
  const std::vector<EarlierFrame> located = run.start.Locate(run.atlas);
  ASSERT_EQ(located.size(), 1U);
  EXPECT_EQ(located[0].id, FrameId{15});
}

TEST(MonocularInitialization, FramesInAMapOfBeforeAreNotThoseOfAYoungOne) {
  YoungRun run;
  run.Track(15);
  run.start.MapLeft();
  run.Track(16);
  const std::vector<EarlierFrame> located = run.start.Locate(run.atlas);
  ASSERT_EQ(located.size(), 1U);
  EXPECT_EQ(located[0].id, FrameId{15});
}

TEST(MonocularInitialization, KeepsABoundedNumberOfFrames) {
  YoungRun run;
  TrackingResult blind = TrackedOf(run.world, 15, KeyFrameId{1}, 14);
  blind.frame.indexed = IndexFeatures(run.world.camera, {});
  for (std::size_t i = 1; i < MonocularInitialization::kMaxFrames; ++i) run.start.Tracked(blind);
  run.Track(16);
  run.Track(17);
  const std::vector<EarlierFrame> located = run.start.Locate(run.atlas);
  ASSERT_EQ(located.size(), 1U);  // a blind frame is not found and keeps its place
  EXPECT_EQ(located[0].id, FrameId{16});
}

TEST(MonocularInitialization, KeepsABoundedNumberOfFramesOfAllMaps) {
  YoungRun run;
  TrackingResult blind = TrackedOf(run.world, 15, KeyFrameId{1}, 14);
  blind.frame.indexed = IndexFeatures(run.world.camera, {});
  constexpr std::size_t kStarts =
      MonocularInitialization::kMostKept / MonocularInitialization::kMaxFrames + 2;
  for (std::size_t start = 0; start < kStarts; ++start) {
    if (start > 0) run.Begin();
    run.Track(16);
    for (std::size_t i = 1; i < MonocularInitialization::kMaxFrames; ++i) run.start.Tracked(blind);
  }
  EXPECT_EQ(run.start.Locate(run.atlas).size(), kStarts - 1);  // each of frame 16
}

TEST(MonocularInitialization, ForgetsWhatWaitedWhenItBeginsAnew) {
  WaitingRun run;
  run.start.Locate(run.atlas);
  for (int i = 2; i < 6; ++i) {
    run.start.Offer(FrameId{i}, MeasuredOf(MonocularFrame(run.world, i)));
  }
  run.start.Restart();
  const InitialMap initial = InitialMapOf(run.world, {10, 14, 22});
  run.start.MapStarted(MapId{0},
                       MakeInitialMapEdit(initial, run.world.Imaging(), Rigid3{}, KeyFrameId{0}));
  EXPECT_TRUE(run.start.Locate(run.atlas).empty());
}

TEST(MonocularInitialization, SaysWhyThereIsNoMap) {
  const SyntheticWorld world = MakeMonocularWorld(500, 0);
  MonocularInitialization start(world.Imaging(), {});
  const ExtractedFrame blind =
      MeasuredOf({FrameId{0}, 0, IndexFeatures(world.camera, {}), nullptr});
  EXPECT_EQ(start.Offer(FrameId{0}, blind).wait, InitializationStatus::kTooFewFeatures);
  for (int i = 1; i < 6; ++i) {  // the camera stands still
    const auto result = start.Offer(FrameId{i}, MeasuredOf(MonocularFrame(world, 0)));
    EXPECT_FALSE(result.map);
    EXPECT_NE(result.wait, InitializationStatus::kNone);
  }
}

}  // namespace
}  // namespace plumbline
