// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/local_ba_window.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace window_gauge_test {

constexpr int kKeyFrames = 7;
using Ids = std::set<KeyFrameId>;

// The first keyframe looks away: the windows of the others are never the whole map.
std::vector<Rigid3> TruePoses() {
  std::vector<Rigid3> poses;
  for (int k = 0; k < kKeyFrames; ++k) poses.push_back(PoseOnPath(8 * k));
  poses.front().rotation = ExpSo3({0, 3, 0});
  return poses;
}

// Those of `held` show every third of their points only, and are fixed in a window for that; all
// others but the first are free, as far as the gauge allows.
struct Scene {
  Scene(double baseline, const Ids& held) {
    world.camera.baseline = baseline;
    scene = MakeTrueMap(world, TruePoses(), {.depth = baseline > 0, .noise = 0.1, .missed = 0});
    MapEdit edit;
    for (const auto& [id, point] : scene.map.points()) {
      for (const auto& [keyframe, feature] : point.observations) {
        if (held.contains(keyframe) && id.value % 3 != 0) {
          edit.push_back(edit::RemovePointObservation{id, keyframe});
        }
      }
    }
    scene.map.Apply(edit);
    options.free_keyframes = kKeyFrames - 1 - static_cast<int>(held.size());
  }

  // Around the newest keyframe.
  LocalBaWindow Window() const {
    return MakeLocalBaWindow(scene.map, world.Imaging(), KeyFrameId{kKeyFrames - 1}, {}, options);
  }

  SyntheticWorld world = MakeSyntheticWorld(300, 40);
  TrueMap scene;
  LocalBaWindowOptions options;
};

Ids Fixed(double baseline, const Ids& held) {
  const LocalBaWindow window = Scene(baseline, held).Window();
  EXPECT_EQ(window.keyframes.size(), kKeyFrames - 1U);
  Ids fixed;
  for (std::size_t i = 0; i < window.keyframes.size(); ++i) {
    if (window.problem.poses[i].fixed) fixed.insert(window.keyframes[i]);
  }
  return fixed;
}

TEST(LocalBaWindow, CountsFixedPosesBetweenFreeOnesToTheGauge) {
  const double stereo = TestCamera().baseline;
  EXPECT_EQ(Fixed(0, {}), (Ids{{1}, {2}}));
  EXPECT_EQ(Fixed(0, {{3}}), (Ids{{1}, {3}})) << "the oldest and the one that was fixed";
  EXPECT_EQ(Fixed(0, {{1}}), (Ids{{1}, {2}})) << "the oldest but the one that was fixed";
  EXPECT_EQ(Fixed(0, {{3}, {5}}), (Ids{{3}, {5}}));
  EXPECT_EQ(Fixed(stereo, {}), (Ids{{1}}));
  EXPECT_EQ(Fixed(stereo, {{4}}), (Ids{{4}}));
}

// Makes the map and some keyframes larger, as another one sees it: which it does not notice.
void Enlarge(Map& map, KeyFrameId eye, const Ids& keyframes) {
  const Eigen::Vector3d centre = Inverse(map.Find(eye)->frame.cam_from_world).translation;
  const auto enlarged = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return centre + 1.05 * (x - centre);
  };
  MapEdit edit;
  for (const KeyFrameId id : keyframes) {
    Rigid3 world_from_cam = Inverse(map.Find(id)->frame.cam_from_world);
    world_from_cam.translation = enlarged(world_from_cam.translation);
    edit.push_back(edit::SetPose{id, Inverse(world_from_cam)});
  }
  for (const auto& [id, point] : map.points()) {
    edit.push_back(edit::MovePoint{id, enlarged(point.position)});
  }
  map.Apply(edit);
}

TEST(LocalBaWindow, TwoPosesBetweenFreeOnesHoldTheScaleOfASingleCamera) {
  const Ids held{{3}, {5}};
  Scene s(0, held);
  Map& map = s.scene.map;
  Enlarge(map, {3}, {{1}, {2}, {4}, {6}});
  const double before = WorstPose(map, TruePoses());
  const LocalBaWindow window = s.Window();
  map.Apply(ToEdit(map, s.world.Imaging(), window, SolveLocalBa(window.problem, {})));
  EXPECT_LT(WorstPose(map, TruePoses()), 0.1 * before);
  for (const KeyFrameId id : held) {
    const Rigid3& pose = map.Find(id)->frame.cam_from_world;
    const Rigid3 truth = TruePoses()[static_cast<std::size_t>(id.value)];
    EXPECT_EQ(pose.translation, truth.translation);
    EXPECT_EQ(pose.rotation.coeffs(), truth.rotation.coeffs());
  }
}

}  // namespace window_gauge_test
}  // namespace plumbline
