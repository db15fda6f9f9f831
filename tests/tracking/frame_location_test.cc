// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/frame_location.h"

#include "tests/support/true_map.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

struct KnownWorld {
  SyntheticWorld world = MakeSyntheticWorld(500, 100);
  TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(20)}, SensorModel{});
  std::shared_ptr<const MapSnapshot> snapshot = TakeSnapshot(scene.map, KeyFrameId{0}, 10);

  std::optional<LocatedFrame> Locate(const FrameFeatures& image, const Rigid3& predicted) const {
    return LocateFrame(world.Imaging(),
                       {world.camera, {}, {}},
                       image,
                       predicted,
                       *snapshot,
                       TrackingOptions{}.max_pose_sigma);
  }
};

TEST(LocateFrame, FindsAFrameFromARoughPrediction) {
  const KnownWorld known;
  for (const SensorModel& sensor : {SensorModel{}, SensorModel{.depth = false}}) {
    Rng rng(3);
    const SyntheticFrame sensed = Sense(known.world, PoseOnPath(8), sensor, rng);
    for (const double off : {0.0, 0.01, 0.05}) {  // 0.05 rad: some 20 px
      Vector6d twist = Vector6d::Zero();
      twist(1) = off;
      const auto located = known.Locate(*sensed.indexed, ExpSe3(twist) * PoseOnPath(8));
      ASSERT_TRUE(located) << off;
      EXPECT_LT(CentreDistance(located->cam_from_world, PoseOnPath(8)), 0.02) << off;
      EXPECT_GT(located->counts.inlier_points, 100);
      EXPECT_GT(located->counts.inlier_lines, 5);
      EXPECT_LE(located->counts.inlier_points, located->counts.matched_points);
    }
  }
}

TEST(LocateFrame, DoesNotInventAPose) {
  const KnownWorld known;
  const SyntheticWorld other = [] {
    SyntheticWorld world = MakeSyntheticWorld(500, 100);
    Rng rng(99);
    for (auto& point : world.points) point.descriptor = RandomDescriptor(rng);
    for (auto& line : world.lines) line.descriptor = RandomDescriptor(rng);
    return world;
  }();
  Rng rng(3);
  EXPECT_FALSE(known.Locate(*Sense(other, PoseOnPath(8), {}, rng).indexed, PoseOnPath(8)));
  EXPECT_FALSE(known.Locate(*IndexFeatures(known.world.camera, {}), PoseOnPath(8)));
}

}  // namespace
}  // namespace plumbline
