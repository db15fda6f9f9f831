// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/exported_map.h"

#include "plumbline/io/trajectory_io.h"
#include "plumbline/map/keyframe_trajectory.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/synthetic_world.h"
#include "tests/support/true_map.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace exported_map_test {

using testing::ElementsAre;
using testing::HasSubstr;

// A map of a rectified camera that is turned against the one delivered.
SavedMap MakeMap() {
  const SyntheticWorld world = MakeSyntheticWorld(40, 0);
  SavedMap saved;
  saved.camera = world.camera;
  saved.rectified_from_left = Eigen::Quaterniond(0.8, 0.6, 0, 0);
  saved.map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(30)}, {.noise = 0}).map;
  return saved;
}

// The keyframes and frames around them, as a run writes them.
Trajectory MakeTrajectory(const SavedMap& saved) {
  const Trajectory keyframes = KeyFrameTrajectory(saved.map, saved.rectified_from_left);
  Trajectory all;
  for (const StampedPose& pose : keyframes) {
    all.push_back(pose);
    for (int i = 1; i <= 2; ++i) {
      all.push_back({pose.stamp_ns + i, pose.world_from_camera});
      all.back().world_from_camera.translation.x() += i;
    }
  }
  return all;
}

TEST(ExportedFrames, AreChosenByName) {
  EXPECT_EQ(ParseExportedFrames("keyframes"), 0);
  EXPECT_EQ(ParseExportedFrames("all"), 1);
  EXPECT_EQ(ParseExportedFrames("every:5"), 5);
  for (const char* text : {"", "every", "every:", "every:-1", "every:0", "every:1.5", "All"}) {
    EXPECT_THAT(MessageOf([&] { ParseExportedFrames(text); }), HasSubstr("--frames")) << text;
  }
}

TEST(FramesBetween, HaveThePosesOfTheRectifiedCamera) {
  const SavedMap saved = MakeMap();
  const Trajectory trajectory = MakeTrajectory(saved);
  const auto frames = FramesBetween(saved, "t", trajectory, 1);
  ASSERT_EQ(frames.size(), 4U);
  const KeyFrame& keyframe = saved.map.keyframes().begin()->second;
  EXPECT_EQ(frames[0].stamp_ns, keyframe.frame.stamp_ns + 1);
  EXPECT_EQ(frames[0].name, std::to_string(keyframe.frame.stamp_ns + 1) + ".png");
  const Rigid3 moved = Inverse(frames[0].cam_from_world);
  const Rigid3 of_keyframe = Inverse(keyframe.frame.cam_from_world);
  EXPECT_LT((moved.translation - of_keyframe.translation - Eigen::Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT(moved.rotation.angularDistance(of_keyframe.rotation), 1e-9);
}

TEST(FramesBetween, AreEveryNthOfThoseWithAPose) {
  const SavedMap saved = MakeMap();
  const Trajectory trajectory = MakeTrajectory(saved);  // k 1 2 k 4 5
  std::vector<std::int64_t> stamps;
  for (const PosedImage& frame : FramesBetween(saved, "t", trajectory, 2)) {
    stamps.push_back(frame.stamp_ns);
  }
  EXPECT_THAT(stamps, ElementsAre(trajectory[2].stamp_ns, trajectory[4].stamp_ns));
}

TEST(FramesBetween, AreOfTheRunThatMadeTheMap) {
  const SavedMap saved = MakeMap();
  Trajectory trajectory = MakeTrajectory(saved);
  const ScratchFolder folder;
  WriteTum(folder / "t.txt", trajectory);  // decimals that the file leaves out are no difference
  EXPECT_EQ(FramesBetween(saved, "t", ReadTrajectory(folder / "t.txt").poses, 1).size(), 4U);
  trajectory[3].world_from_camera.translation.x() += 1e-3;
  EXPECT_THAT(MessageOf([&] { (void)FramesBetween(saved, "a/t.txt", trajectory, 1); }),
              HasSubstr("a/t.txt: expected the poses of the run that made the map, found another "
                        "one at " +
                        FormatStamp(trajectory[3].stamp_ns) + " s, where the map has keyframe 1"));
  for (StampedPose& pose : trajectory) pose.stamp_ns += 10;
  EXPECT_THAT(MessageOf([&] { (void)FramesBetween(saved, "t", trajectory, 1); }),
              HasSubstr("found none at"));
}

TEST(TrajectoryBeside, IsThatOfTheMap) {
  const ScratchFolder folder;
  const auto map = folder / "map.plb";
  EXPECT_THAT(MessageOf([&] { (void)TrajectoryBeside(map, MapId{2}); }),
              HasSubstr("--frames: expected the poses of all frames in " +
                        (folder / "trajectory.txt").string()));
  folder.Write("trajectory.txt", "");
  EXPECT_EQ(TrajectoryBeside(map, MapId{2}), folder / "trajectory.txt");
  folder.Write("trajectory_map2.txt", "");
  EXPECT_EQ(TrajectoryBeside(map, MapId{2}), folder / "trajectory_map2.txt");
  EXPECT_EQ(TrajectoryBeside(map, MapId{1}), folder / "trajectory.txt");
}

}  // namespace exported_map_test
}  // namespace plumbline
