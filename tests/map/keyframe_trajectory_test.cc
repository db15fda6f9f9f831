// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/keyframe_trajectory.h"

#include "plumbline/map/combined_atlases.h"

#include "tests/support/true_map.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(KeyFrameTrajectory, HasOnePoseAtATimeTheOldest) {
  const SyntheticWorld world = MakeSyntheticWorld(60, 10);
  Map map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10), PoseOnPath(20)}, {}).map;
  const Eigen::Quaterniond turn = ExpSo3({0, 0.1, 0});
  const Trajectory alone = KeyFrameTrajectory(map, turn);
  ASSERT_EQ(alone.size(), 3U);
  const KeyFrame& last = map.keyframes().rbegin()->second;
  EXPECT_EQ(alone.back().stamp_ns, last.frame.stamp_ns);
  const Rigid3 expected =
      Inverse(last.frame.cam_from_world) * Rigid3{turn, Eigen::Vector3d::Zero()};
  EXPECT_LT(CentreDistance(Inverse(alone.back().world_from_camera), Inverse(expected)), 1e-12);
  EXPECT_LT(alone.back().world_from_camera.rotation.angularDistance(expected.rotation), 1e-12);
  // Another map of the same times, elsewhere.
  map.Absorb(Renumbered(map, Behind(map)), {1, ExpSo3({0, 1, 0}), {100, 0, 0}});
  ASSERT_EQ(map.keyframes().size(), 6U);
  const Trajectory merged = KeyFrameTrajectory(map, turn);
  ASSERT_EQ(merged.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(merged[i].stamp_ns, alone[i].stamp_ns);
    EXPECT_EQ(merged[i].world_from_camera.translation, alone[i].world_from_camera.translation);
  }
}

}  // namespace
}  // namespace plumbline
