// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/relocalization.h"

#include "tests/support/most_alike.h"
#include "tests/support/true_map.h"
#include <functional>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Relocalizer MakeRelocalizer(const SyntheticWorld& world) {
  return Relocalizer(world.Imaging(), {}, {world.camera, {}, {}});
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

std::optional<Relocalized> Find(const Relocalizer& relocalizer,
                                const Map& map,
                                const Frame& frame,
                                const std::vector<KeyFrameId>& candidates) {
  std::vector<PlaceToTry> places;
  for (const KeyFrameId id : candidates) places.push_back({&map, id});
  return relocalizer.Find(frame, places);
}

std::optional<Relocalized> Find(const Relocalizer& relocalizer,
                                const Map& map,
                                const Frame& frame) {
  return Find(relocalizer, map, frame, MostAlikeOf(map, frame.features()));
}

// A second room with copies of all keyframes and landmarks, some metres away; `looks` changes what
// a keyframe shows. Returns the new keyframes.
std::vector<KeyFrameId> AppendCopy(
    Map& map, const std::function<void(Frame&)>& looks = [](Frame&) {}) {
  const Eigen::Vector3d away(0, 0, 30);
  const Rigid3 shift{Eigen::Quaterniond::Identity(), away};
  MapEdit edit;
  std::vector<KeyFrameId> ids;
  const std::int64_t first = map.NextKeyFrameId().value;
  for (std::int64_t k = 0; k < first; ++k) {
    KeyFrame copy = *map.Find(KeyFrameId{k});
    copy.id = KeyFrameId{first + k};
    copy.parent = KeyFrameId{first + k - 1};
    copy.frame.cam_from_world = copy.frame.cam_from_world * Inverse(shift);
    copy.frame.points.assign(copy.frame.points.size(), PointId{});
    copy.frame.lines.assign(copy.frame.lines.size(), LineId{});
    looks(copy.frame);
    ids.push_back(copy.id);
    edit.push_back(edit::AddKeyFrame{copy});
  }
  PointId next = map.NextPointId();
  for (const auto& [id, point] : map.points()) {
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
  map.Apply(edit);
  return ids;
}

TEST(Relocalizer, FindsAFrameBetweenKeyFrames) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  const TrueMap scene = MapOf(world, 10);
  const Relocalizer relocalizer = MakeRelocalizer(world);
  for (const int frame : {3, 27, 50}) {
    const auto found = Find(relocalizer, scene.map, UnplacedFrame(world, frame));
    ASSERT_TRUE(found) << frame;
    EXPECT_LT(CentreDistance(found->frame.cam_from_world, PoseOnPath(frame)), 0.02) << frame;
    EXPECT_GE(found->Inliers(), 30);
    EXPECT_NE(scene.map.Find(found->keyframe), nullptr);
    EXPECT_EQ(found->association.matches.Points() + found->association.matches.Lines(),
              found->Inliers());
  }
}

// Odometry tracks against the frame before, which a lost camera has not.
TEST(Relocalizer, FindsAFrameForOdometryInTheMapAllTheSame) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  const TrueMap scene = MapOf(world, 10);
  TrackingOptions odometry;
  odometry.reference = TrackingReference::kLastFrame;
  const Relocalizer relocalizer(world.Imaging(), odometry, {world.camera, {}, {}});
  const auto found = Find(relocalizer, scene.map, UnplacedFrame(world, 27));
  ASSERT_TRUE(found);
  EXPECT_LT(CentreDistance(found->frame.cam_from_world, PoseOnPath(27)), 0.02);
}

TEST(Relocalizer, IsTheSameEveryTime) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  const TrueMap scene = MapOf(world, 6);
  const Frame frame = UnplacedFrame(world, 20);
  const auto a = Find(MakeRelocalizer(world), scene.map, frame);
  const auto b = Find(MakeRelocalizer(world), scene.map, frame);
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
  const std::vector<KeyFrameId> all = KeyFramesOf(scene.map);
  EXPECT_FALSE(Find(MakeRelocalizer(world), scene.map, UnplacedFrame(other, 10), all));
  EXPECT_FALSE(Find(MakeRelocalizer(world), Map{}, UnplacedFrame(world, 10), all));
}

TEST(Relocalizer, TriesTheCandidatesAlone) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  const TrueMap scene = MapOf(world, 6);
  const Frame frame = UnplacedFrame(world, 12);
  const Relocalizer relocalizer = MakeRelocalizer(world);
  EXPECT_FALSE(Find(relocalizer, scene.map, frame, {}));
  EXPECT_FALSE(Find(relocalizer, scene.map, frame, {KeyFrameId{99}}));
  const auto found = Find(relocalizer, scene.map, frame, {KeyFrameId{99}, KeyFrameId{2}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keyframe, KeyFrameId{2});
}

TEST(Relocalizer, FindsAFrameInASnapshotAloneWhereItWasTaken) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 80);
  const TrueMap scene = MapOf(world, 10);
  const auto snapshot = TakeSnapshot(scene.map, KeyFrameId{2});
  const Relocalizer relocalizer = MakeRelocalizer(world);
  const auto found = relocalizer.Find(UnplacedFrame(world, 13), *snapshot);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keyframe, KeyFrameId{2});
  EXPECT_LT(CentreDistance(found->frame.cam_from_world, PoseOnPath(13)), 0.02);
  Frame blank = UnplacedFrame(world, 13);
  blank.indexed = IndexFeatures(world.camera, {});
  blank.points.clear();
  blank.lines.clear();
  EXPECT_FALSE(relocalizer.Find(blank, *snapshot));
}

// Eight keyframes of one place, where the frame is not, do not keep it from the one where it is.
TEST(Relocalizer, TriesCandidatesOfDifferentPlaces) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 60);
  TrueMap scene = MapOf(world, 8);
  Rng rng(9, "other looks");
  std::vector<KeyFrameId> candidates = AppendCopy(scene.map, [&](Frame& frame) {
    Features features = frame.features();
    for (PointFeature& point : features.points) point.descriptor = RandomDescriptor(rng);
    for (LineFeature& line : features.lines) line.descriptor = RandomDescriptor(rng);
    frame.indexed = IndexFeatures(world.camera, features);
  });
  candidates.push_back(KeyFrameId{3});
  const auto found = Find(MakeRelocalizer(world), scene.map, UnplacedFrame(world, 18), candidates);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keyframe, KeyFrameId{3});
}

// The same wall twice, ten metres apart: either place explains the frame.
TEST(Relocalizer, BelievesNeitherOfTwoPlacesThatLookTheSame) {
  const SyntheticWorld wall = MakeSyntheticWorld(300, 60);
  TrueMap scene = MapOf(wall, 2);
  const Frame frame = UnplacedFrame(wall, 3);
  EXPECT_TRUE(Find(MakeRelocalizer(wall), scene.map, frame));
  AppendCopy(scene.map);
  EXPECT_FALSE(Find(MakeRelocalizer(wall), scene.map, frame));
}

}  // namespace
}  // namespace plumbline
