// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/monocular_start.h"

#include "tests/support/initial_map_of.h"
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

MeasuredFrame MeasuredOf(const InitializationFrame& frame) {
  MeasuredFrame measured;
  measured.stamp_ns = frame.stamp_ns;
  measured.images.left = GrayImage(8, 6);
  measured.indexed = frame.indexed;
  return measured;
}

// Frames 2 to 22 wait; the map is that of frames 10, 14 and 22.
struct WaitingRun {
  SyntheticWorld world = MakeMonocularWorld(500, 80);
  MonocularStart start{world.Imaging(), {}};
  std::vector<Map> maps{Map(MapId{0})};

  WaitingRun() {
    for (int i = 2; i <= 22; ++i) {
      start.Offer(FrameId{i}, MeasuredOf(MonocularFrame(world, i)));
    }
    const InitialMap initial = InitialMapOf(world, {10, 14, 22});
    const MapStart map_start = MakeMapStart(initial, world.Imaging(), Rigid3{}, KeyFrameId{0});
    maps[0].Apply(map_start.edit);
    start.MapStarted(MapId{0}, map_start);
  }
};

TEST(MonocularStart, LocatesTheFramesThatWaited) {
  WaitingRun run;
  const std::vector<EarlierFrame> located = run.start.Locate(run.maps);
  std::set<FrameId> found;
  for (const EarlierFrame& frame : located) {
    found.insert(frame.id);
    EXPECT_EQ(frame.map, MapId{0});
    EXPECT_EQ(frame.reference, KeyFrameId{0});
    EXPECT_GT(frame.counts.inlier_points, 50);
    const Rigid3 pose = frame.cam_from_reference * run.maps[0].PoseOf(frame.reference);
    const Rigid3 truth = InMapUnit(PoseOnPath(static_cast<int>(frame.id.value)));
    EXPECT_LT(CentreDistance(pose, truth) * kMapUnit, 0.02) << frame.id.value;
  }
  // All but the keyframes, those before the first one included.
  EXPECT_EQ(found.size(), 18U);
  for (const int keyframe : {10, 14, 22}) EXPECT_FALSE(found.contains(FrameId{keyframe}));
  EXPECT_TRUE(run.start.Locate(run.maps).empty());  // once
}

TEST(MonocularStart, ForgetsWhatWaitedWhenItBeginsAnew) {
  WaitingRun run;
  run.start.Locate(run.maps);
  for (int i = 2; i < 6; ++i) {
    run.start.Offer(FrameId{i}, MeasuredOf(MonocularFrame(run.world, i)));
  }
  run.start.Restart();
  const InitialMap initial = InitialMapOf(run.world, {10, 14, 22});
  run.start.MapStarted(MapId{0},
                       MakeMapStart(initial, run.world.Imaging(), Rigid3{}, KeyFrameId{0}));
  EXPECT_TRUE(run.start.Locate(run.maps).empty());
}

TEST(MonocularStart, SaysWhyThereIsNoMap) {
  const SyntheticWorld world = MakeMonocularWorld(500, 0);
  MonocularStart start(world.Imaging(), {});
  const MeasuredFrame blind = MeasuredOf({FrameId{0}, 0, IndexFeatures(world.camera, {}), nullptr});
  EXPECT_EQ(start.Offer(FrameId{0}, blind).wait, InitializationWait::kTooFewFeatures);
  for (int i = 1; i < 6; ++i) {  // the camera stands still
    const auto result = start.Offer(FrameId{i}, MeasuredOf(MonocularFrame(world, 0)));
    EXPECT_FALSE(result.map);
    EXPECT_NE(result.wait, InitializationWait::kNone);
  }
}

}  // namespace
}  // namespace plumbline
