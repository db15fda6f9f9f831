// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/map_correction.h"

#include "tests/support/true_map.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr std::int64_t kKeyFrames = 6;

// A map of keyframes 0 to 5, and a correction that turns, shifts and scales the world around each
// keyframe a little more than around the one before.
struct Scene {
  SyntheticWorld world = MakeSyntheticWorld(150, 40);
  TrueMap truth;
  MapCorrection correction;

  explicit Scene(double scale_step = 0) {
    std::vector<Rigid3> poses;
    for (int k = 0; k < kKeyFrames; ++k) poses.push_back(PoseOnPath(4 * k));
    truth = MakeTrueMap(world, poses, {});
    for (const auto& [id, keyframe] : map().keyframes()) {
      const Rigid3& before = keyframe.frame.cam_from_world;
      const auto k = static_cast<double>(id.value);
      Vector6d twist;
      twist << 0.01 * k, 0, -0.005 * k, 0.02 * k, 0.01 * k, 0;
      correction.keyframes[id] = {before, ExpSe3(twist) * before, 1 + scale_step * k};
    }
    for (const auto& [id, point] : map().points()) {
      correction.points[id] = {point.position, 1.01 * point.position};
    }
  }

  Map& map() { return truth.map; }
  void Apply() { map().Apply(RebaseCorrection(correction, map())); }
};

double Difference(const Rigid3& a, const Rigid3& b) { return LogSe3(a * Inverse(b)).norm(); }

TEST(MapCorrection, GivesAnUntouchedMapExactlyThePlacesFound) {
  Scene scene;
  scene.Apply();
  for (const auto& [id, place] : scene.correction.keyframes) {
    EXPECT_EQ(scene.map().PoseOf(id).translation, place.after.translation);
    EXPECT_EQ(scene.map().PoseOf(id).rotation.coeffs(), place.after.rotation.coeffs());
  }
  for (const auto& [id, place] : scene.correction.points) {
    EXPECT_EQ(scene.map().Find(id)->position, place.after);
  }
  scene.map().CheckInvariants();
}

TEST(MapCorrection, GivesTheMapItsLensAndLeavesTheStereoCorrection) {
  Scene scene;
  const RectifiedCamera& camera = scene.world.camera;
  const FeatureCorrection before{{camera, 0.5 * Vector6d::Unit(0)}, {camera, 1}};
  scene.map().Apply({edit::CorrectFeatures{before}});
  scene.Apply();
  EXPECT_EQ(scene.map().correction(), before);
  scene.correction.lens = LensCorrection(camera, 3);
  scene.Apply();
  EXPECT_EQ(scene.map().correction(), (FeatureCorrection{before.stereo, {camera, 3}}));
}

TEST(MapCorrection, OfNothingChangesNothing) {
  Scene scene;
  EXPECT_TRUE(RebaseCorrection({}, scene.map()).empty());
}

TEST(MapCorrection, KeepsWhatAdjustmentDidMeanwhile) {
  Scene scene;
  const KeyFrameId moved{4};
  const Rigid3 old_pose = scene.map().PoseOf(moved);
  const Rigid3 meanwhile = ExpSe3(Vector6d::Constant(0.003)) * old_pose;
  const MapPoint& first = scene.map().points().begin()->second;
  const PointId point = first.id;
  const Eigen::Vector3d shifted = first.position + Eigen::Vector3d(0, 0.01, 0);
  const KeyFrameId newest = first.observations.newest().first;
  scene.map().Apply({edit::SetPose{moved, meanwhile}, edit::MovePoint{point, shifted}});
  scene.Apply();
  // Seen from the corrected keyframe, the change is what it was.
  const Rigid3 after = scene.map().PoseOf(moved);
  EXPECT_LT(Difference(after * Inverse(scene.correction.keyframes[moved].after),
                       meanwhile * Inverse(old_pose)),
            1e-9);
  // The point lies before its newest keyframe as it did.
  const auto& place = scene.correction.keyframes[newest];
  EXPECT_LT((place.after * scene.map().Find(point)->position - place.before * shifted).norm(),
            1e-9);
}

// Keyframes 6 and 7 and a point that only they show come after the computation began; keyframe 6
// has left again.
TEST(MapCorrection, TakesWhatCameMeanwhileAlong) {
  Scene scene(0.1);
  Map& map = scene.map();
  const auto add = [&](int frame) {
    Rng rng(static_cast<std::uint64_t>(frame), "later");
    const SyntheticFrame sensed = Sense(scene.world, PoseOnPath(frame), {}, rng);
    return AddKeyFrameTo(map, PoseOnPath(frame), sensed);
  };
  const KeyFrameId six = add(24);
  const KeyFrameId seven = add(28);
  MapPoint late;
  late.id = map.NextPointId();
  late.position = {0.3, 0.2, 5};
  late.created_by = seven;
  late.observations = {{seven, 3}};
  map.Apply({edit::AddPoint{late}, edit::RemoveKeyFrame{six}});
  const KeyFrameId parent{kKeyFrames - 1};
  const Rigid3 beside = map.PoseOf(seven) * Inverse(map.PoseOf(parent));
  const Eigen::Vector3d seen = map.PoseOf(seven) * late.position;
  scene.Apply();
  const double scale = scene.correction.keyframes[parent].scale;
  const auto scaled = [&](Rigid3 motion) {
    motion.translation *= scale;
    return motion;
  };
  EXPECT_LT(Difference(map.PoseOf(seven) * Inverse(map.PoseOf(parent)), scaled(beside)), 1e-9);
  EXPECT_LT((map.PoseOf(seven) * map.Find(late.id)->position - scale * seen).norm(), 1e-9);
  EXPECT_NEAR(map.PlaceOf(seven).scale, scale, 1e-12);
  EXPECT_NEAR(map.PlaceOf(six).scale, scale, 1e-12);
  map.CheckInvariants();
}

TEST(MapCorrection, LeavesOutWhatHasLeftTheMap) {
  Scene scene;
  const PointId gone = scene.map().points().begin()->first;
  scene.map().Apply({edit::RemovePoint{gone}, edit::RemoveKeyFrame{KeyFrameId{3}}});
  const Rigid3 beside =
      scene.map().PoseOf(KeyFrameId{3}) * Inverse(scene.map().PoseOf(KeyFrameId{2}));
  scene.Apply();
  EXPECT_EQ(scene.map().Find(gone), nullptr);
  EXPECT_LT(
      Difference(scene.map().PoseOf(KeyFrameId{3}) * Inverse(scene.map().PoseOf(KeyFrameId{2})),
                 beside),
      1e-9);
  scene.map().CheckInvariants();
}

}  // namespace
}  // namespace plumbline
