// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/outlier_removal.h"

#include "tests/support/misfits.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace outlier_removal_test {

std::vector<Rigid3> TruePoses() {
  std::vector<Rigid3> poses;
  for (int k = 0; k < 8; ++k) poses.push_back(PoseOnPath(8 * k));
  return poses;
}

TrueMap SceneOf(const SyntheticWorld& world) {
  return MakeTrueMap(world, TruePoses(), {.noise = 0.3, .missed = 0});
}

void Clean(const SyntheticWorld& world, Map& map) {
  map.Apply(RemoveOutliers(map, world.Imaging(), LineOptions{}));
  map.CheckInvariants();
}

using Wrong = std::pair<KeyFrameId, LineId>;

// Exchanges the observations of two lines in one keyframe in the middle of their tracks. Returns
// the observations that are wrong now.
std::set<Wrong> ExchangeLines(TrueMap& scene, KeyFrameId keyframe, LineId a, LineId b) {
  const int of_a = scene.map.Find(a)->observations.at(keyframe);
  const int of_b = scene.map.Find(b)->observations.at(keyframe);
  scene.map.Apply({edit::RemoveLineObservation{a, keyframe},
                   edit::RemoveLineObservation{b, keyframe},
                   edit::AddLineObservation{a, keyframe, of_b},
                   edit::AddLineObservation{b, keyframe, of_a}});
  return {{keyframe, a}, {keyframe, b}};
}

TEST(RemoveOutliers, ChangesNothingWhereAllAgree) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  const TrueMap scene = SceneOf(world);
  EXPECT_TRUE(RemoveOutliers(scene.map, world.Imaging(), LineOptions{}).empty());
  EXPECT_TRUE(RemoveOutliers(Map(), world.Imaging(), LineOptions{}).empty());
}

TEST(RemoveOutliers, TakesAwayWhatIsWrongInTheMiddleOfATrack) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  TrueMap scene = SceneOf(world);
  std::vector<LineId> long_seen;
  for (const auto& [id, line] : scene.map.lines()) {
    if (line.observations.size() == TruePoses().size()) long_seen.push_back(id);
  }
  ASSERT_GE(long_seen.size(), 10U);
  std::set<Wrong> wrong;
  for (std::size_t i = 0; i + 1 < long_seen.size(); i += 2) {
    wrong.merge(ExchangeLines(scene, KeyFrameId{4}, long_seen[i], long_seen[i + 1]));
  }
  const Map before = scene.map;
  ASSERT_GE(CountMisfits(before, world.camera).lines.beyond, static_cast<int>(wrong.size()));
  Clean(world, scene.map);
  EXPECT_EQ(CountMisfits(scene.map, world.camera).lines.beyond, 0);
  EXPECT_EQ(scene.map.lines().size(), before.lines().size());
  for (const auto& [id, line] : before.lines()) {
    for (const auto& [keyframe, feature] : line.observations) {
      EXPECT_EQ(scene.map.Find(id)->observations.contains(keyframe),
                !wrong.contains({keyframe, id}))
          << id.value << " in " << keyframe.value;
    }
  }
}

// Nothing shows these landmarks where they are now: not the observations are wrong.
TEST(RemoveOutliers, FitsLandmarksThatKeyFramesLeftBehind) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  TrueMap scene = SceneOf(world);
  const Map before = scene.map;
  MapEdit edit;
  const Eigen::Vector3d shift(0.05, 0.05, 0.05);
  for (const auto& [id, point] : before.points()) {
    edit.push_back(edit::MovePoint{id, point.position + shift});
  }
  for (const auto& [id, line] : before.lines()) {
    const PluckerLine moved = Transform(Rigid3{Eigen::Quaterniond::Identity(), shift}, line.line);
    edit.push_back(edit::MoveLine{id, moved, line.start, line.end, line.information});
  }
  scene.map.Apply(edit);
  ASSERT_GT(CountMisfits(scene.map, world.camera).points.Share(), 0.5);
  ASSERT_GT(CountMisfits(scene.map, world.camera).lines.Share(), 0.5);
  Clean(world, scene.map);
  const Misfits after = CountMisfits(scene.map, world.camera);
  const Misfits truth = CountMisfits(before, world.camera);
  EXPECT_EQ(after.points.beyond + after.lines.beyond, 0);
  EXPECT_GE(after.points.all, 0.98 * truth.points.all);
  EXPECT_GE(after.lines.all, 0.95 * truth.lines.all);
}

TEST(RemoveOutliers, RemovesLandmarksThatTooFewKeyFramesShow) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  TrueMap scene = SceneOf(world);
  // Three keyframes show each of these points, one of them something else: the other two would
  // agree with some point nearly always.
  MapEdit edit;
  std::vector<PointId> broken;
  for (const auto& [id, point] : scene.map.points()) {
    if (point.observations.size() != TruePoses().size() || broken.size() == 10) continue;
    broken.push_back(id);
    for (const auto& [keyframe, feature] : point.observations) {
      if (keyframe.value > 2) edit.push_back(edit::RemovePointObservation{id, keyframe});
    }
  }
  ASSERT_EQ(broken.size(), 10U);
  Features features = scene.map.Find(KeyFrameId{0})->frame.features();
  for (const PointId id : broken) {
    const int feature = scene.map.Find(id)->observations.at(KeyFrameId{0});
    features.points[static_cast<std::size_t>(feature)].px.y() += 40;
  }
  edit.push_back(
      edit::MoveFeatures{KeyFrameId{0}, IndexFeatures(world.camera, std::move(features))});
  scene.map.Apply(edit);
  const std::size_t before = scene.map.points().size();
  Clean(world, scene.map);
  for (const PointId id : broken) EXPECT_EQ(scene.map.Find(id), nullptr) << id.value;
  EXPECT_EQ(scene.map.points().size(), before - broken.size());
}

}  // namespace outlier_removal_test
}  // namespace plumbline
