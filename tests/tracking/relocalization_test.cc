// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/relocalization.h"

#include "tests/support/true_map.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Relocalizer MakeRelocalizer(const SyntheticWorld& world,
                            const RelocalizationOptions& options = {}) {
  return Relocalizer(world.Imaging(), {}, {}, {}, options);
}

// Keyframes along a walk.
TrueMap MapOf(const SyntheticWorld& world, int keyframes) {
  std::vector<Rigid3> poses;
  for (int k = 0; k < keyframes; ++k) poses.push_back(PoseOnPath(6 * k));
  return MakeTrueMap(world, poses, {});
}

// A frame that knows nothing of where it is.
Frame UnplacedFrame(const SyntheticWorld& world, int on_path, const SensorModel& sensor = {}) {
  Rng rng(static_cast<std::uint64_t>(on_path), "unplaced");
  return MakeFrame(FrameId{on_path}, Rigid3{}, Sense(world, PoseOnPath(on_path), sensor, rng));
}

TEST(Relocalizer, FindsAFrameBetweenKeyFrames) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  const TrueMap scene = MapOf(world, 10);
  const Relocalizer relocalizer = MakeRelocalizer(world);
  for (const int frame : {3, 27, 50}) {
    const auto found = relocalizer.Find(scene.map, UnplacedFrame(world, frame), 0);
    ASSERT_TRUE(found) << frame;
    EXPECT_LT(CentreDistance(found->frame.cam_from_world, PoseOnPath(frame)), 0.02) << frame;
    EXPECT_GE(found->Inliers(), 30);
    EXPECT_NE(scene.map.Find(found->keyframe), nullptr);
    EXPECT_EQ(found->association.matches.Points() + found->association.matches.Lines(),
              found->Inliers());
  }
}

TEST(Relocalizer, IsTheSameEveryTime) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  const TrueMap scene = MapOf(world, 6);
  const Frame frame = UnplacedFrame(world, 20);
  const auto a = MakeRelocalizer(world).Find(scene.map, frame, 0);
  const auto b = MakeRelocalizer(world).Find(scene.map, frame, 0);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->frame.cam_from_world.translation, b->frame.cam_from_world.translation);
  EXPECT_EQ(a->keyframe, b->keyframe);
}

TEST(Relocalizer, FindsNothingInAnotherWorldOrAnEmptyMap) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  SyntheticWorld other = world;
  Rng rng(9, "other looks");
  for (auto& point : other.points) point.descriptor = RandomDescriptor(rng);
  for (auto& line : other.lines) line.descriptor = RandomDescriptor(rng);
  const TrueMap scene = MapOf(world, 6);
  EXPECT_FALSE(MakeRelocalizer(world).Find(scene.map, UnplacedFrame(other, 10), 0));
  EXPECT_FALSE(MakeRelocalizer(world).Find(Map{}, UnplacedFrame(world, 10), 0));
}

TEST(Relocalizer, TakesOtherKeyFramesWithEachAttempt) {
  // Only the last of five keyframes shows what the frame shows.
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  TrueMap scene = MapOf(world, 5);
  MapEdit forget;
  for (const auto& [id, point] : scene.map.points()) {
    for (const auto& [keyframe, feature] : point.observations) {
      if (keyframe != KeyFrameId{4}) forget.push_back(edit::RemovePointObservation{id, keyframe});
    }
  }
  for (const auto& [id, line] : scene.map.lines()) {
    for (const auto& [keyframe, feature] : line.observations) {
      if (keyframe != KeyFrameId{4}) forget.push_back(edit::RemoveLineObservation{id, keyframe});
    }
  }
  scene.map.Apply(forget);
  const Relocalizer relocalizer = MakeRelocalizer(world, {.max_keyframes = 2});
  const Frame frame = UnplacedFrame(world, 24);
  int found = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    found += relocalizer.Find(scene.map, frame, attempt).has_value();
  }
  EXPECT_EQ(found, 1);
}

// The same wall twice, ten metres apart: either place explains the frame.
TEST(Relocalizer, BelievesNeitherOfTwoPlacesThatLookTheSame) {
  SyntheticWorld wall = MakeSyntheticWorld(300, 60);
  TrueMap scene = MapOf(wall, 2);
  const Eigen::Vector3d away(0, 0, 30);
  const Rigid3 shift{Eigen::Quaterniond::Identity(), away};
  // A second room with copies of all keyframes and landmarks.
  MapEdit edit;
  const std::int64_t first = scene.map.NextKeyFrameId().value;
  for (std::int64_t k = 0; k < first; ++k) {
    KeyFrame copy = *scene.map.Find(KeyFrameId{k});
    copy.id = KeyFrameId{first + k};
    copy.parent = KeyFrameId{first + k - 1};
    copy.frame.cam_from_world = copy.frame.cam_from_world * Inverse(shift);
    copy.frame.points.assign(copy.frame.points.size(), PointId{});
    copy.frame.lines.assign(copy.frame.lines.size(), LineId{});
    edit.push_back(edit::AddKeyFrame{copy});
  }
  PointId next = scene.map.NextPointId();
  for (const auto& [id, point] : scene.map.points()) {
    MapPoint copy = point;
    copy.id = next;
    ++next.value;
    copy.position += away;
    copy.observations = {};
    for (const auto& [keyframe, feature] : point.observations) {
      copy.observations.emplace(KeyFrameId{first + keyframe.value}, feature);
    }
    edit.push_back(edit::AddPoint{copy});
    edit.push_back(edit::RefreshPoint{copy.id});
  }
  const Frame frame = UnplacedFrame(wall, 3);
  EXPECT_TRUE(MakeRelocalizer(wall).Find(scene.map, frame, 0));
  scene.map.Apply(edit);
  EXPECT_FALSE(MakeRelocalizer(wall).Find(scene.map, frame, 0));
}

}  // namespace
}  // namespace plumbline
