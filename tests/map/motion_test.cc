// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/motion.h"

#include "plumbline/base/random.h"
#include "plumbline/map/map.h"

#include "tests/map/map_fixture.h"
#include "tests/support/random_geometry.h"
#include <algorithm>
#include <vector>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

Similarity3 RandomSimilarity(Rng& rng, double scale) {
  const Rigid3 motion = RandomRigid(rng, 3, 2);
  return {scale, motion.rotation, motion.translation};
}

LineModel RandomLine(Rng& rng) {
  LineModel line;
  const Eigen::Vector3d start = RandomVector<3>(rng, 3);
  line.line = LineThroughPoints(start, start + RandomVector<3>(rng));
  line.start = line.line.ParameterOf(start);
  line.end = line.start + 1.5;
  line.view_direction = RandomVector<3>(rng).normalized();
  const Eigen::Matrix4d root = Eigen::Matrix4d::Random();
  line.information = root * root.transpose() + Eigen::Matrix4d::Identity();
  return line;
}

TEST(Motion, ALineGoesThroughItsMovedPoints) {
  Rng rng(1);
  for (int k = 0; k < 50; ++k) {
    LineModel line = RandomLine(rng);
    const Similarity3 motion = RandomSimilarity(rng, rng.Uniform(0.2, 5));
    const Segment3 before = line.Interval();
    const Eigen::Vector3d seen_from = line.view_direction;
    Move(motion, line);
    EXPECT_NEAR(line.line.direction.norm(), 1, 1e-12);
    EXPECT_NEAR(line.line.direction.dot(line.line.moment), 0, 1e-10);
    EXPECT_LT((line.Interval().start - motion * before.start).norm(), 1e-9);
    EXPECT_LT((line.Interval().end - motion * before.end).norm(), 1e-9);
    EXPECT_LT((line.view_direction - motion.rotation * seen_from).norm(), 1e-12);
  }
}

// The tangent of `line` that leads to `other`, which is near.
Eigen::Vector4d TangentTo(const PluckerLine& line, const PluckerLine& other) {
  const OrthonormalLine from = ToOrthonormal(line);
  Eigen::Matrix<double, 6, 1> h = ToOrthonormal(other).Homogeneous();
  if (h.dot(from.Homogeneous()) < 0) h = -h;
  return HomogeneousJacobian(from).completeOrthogonalDecomposition().solve(h - from.Homogeneous());
}

// What the information says of a small error of the line does not depend on where the line lies.
TEST(Motion, TheInformationOfALineIsThatOfTheSameErrorsThere) {
  Rng rng(2);
  for (int k = 0; k < 50; ++k) {
    const LineModel before = RandomLine(rng);
    const Similarity3 motion = RandomSimilarity(rng, rng.Uniform(0.2, 5));
    LineModel after = before;
    Move(motion, after);
    const Eigen::Vector4d error = RandomVector<4>(rng, 1e-6);
    const PluckerLine wrong = ToPlucker(Retract(ToOrthonormal(before.line), error));
    const Eigen::Vector4d moved = TangentTo(after.line, Transform(motion, wrong));
    const double chi2 = error.dot(before.information * error);
    EXPECT_NEAR(moved.dot(after.information * moved) / chi2, 1, 1e-4);
    EXPECT_TRUE(after.information.isApprox(after.information.transpose(), 1e-9));
  }
}

// Keyframes 0 to 4 on a path that all show points 0 to 29 and lines 0 to 9.
struct Scene {
  RectifiedCamera camera = TestCamera();
  Rng rng{3};
  Map map = ChainOfKeyFrames(5);

  Scene() {
    for (std::int64_t k = 0; k < 5; ++k) {
      const Rigid3 near{ExpSo3(RandomVector<3>(rng, 0.1)), RandomVector<3>(rng, 0.3)};
      map.Apply({edit::SetPose{KeyFrameId{k}, near}});
    }
    for (std::int64_t i = 0; i < 30; ++i) {
      MapPoint point = PointSeenBy(i, SeenBy(0, 4, static_cast<int>(i)));
      point.position = RandomVector<3>(rng) + Eigen::Vector3d(0, 0, 6);
      point.view_direction = Eigen::Vector3d::UnitZ();
      point.reference_distance = 5;
      map.Apply({edit::AddPoint{point}});
    }
    for (std::int64_t i = 0; i < 10; ++i) {
      MapLine line = LineSeenBy(i, SeenBy(0, 4, static_cast<int>(i)));
      static_cast<LineModel&>(line) = RandomLine(rng);
      map.Apply({edit::AddLine{line}});
    }
  }

  edit::MoveKeyFrames All(const Similarity3& motion) const {
    edit::MoveKeyFrames change;
    for (const auto& [id, keyframe] : map.keyframes()) change.new_from_old[id] = motion;
    return change;
  }

  // Image positions of all points and of the ends of all lines, and disparities of the points.
  std::vector<double> Seen(const Rigid3& cam_from_world) const {
    std::vector<double> seen;
    const auto add = [&](const Eigen::Vector3d& p) {
      const Eigen::Vector3d in_camera = cam_from_world * p;
      const Eigen::Vector2d px = camera.Project(in_camera);
      seen.insert(seen.end(), {px.x(), px.y(), camera.DisparityFromDepth(in_camera.z())});
    };
    for (const auto& [id, point] : map.points()) add(point.position);
    for (const auto& [id, line] : map.lines()) {
      add(line.Interval().start);
      add(line.Interval().end);
    }
    return seen;
  }
  std::vector<double> SeenByAll() const {
    std::vector<double> all;
    for (std::int64_t k = 0; k < 5; ++k) {
      const std::vector<double> one = Seen(map.PoseOf(KeyFrameId{k}));
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  }
};

double LargestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(Motion, NoReprojectionOrDisparityChangesInARigidMotionOfAll) {
  for (int k = 0; k < 20; ++k) {
    Scene scene;
    const std::vector<double> before = scene.SeenByAll();
    scene.map.Apply({scene.All(RandomSimilarity(scene.rng, 1))});
    EXPECT_LT(LargestDifference(scene.SeenByAll(), before), 1e-6);
  }
}

TEST(Motion, DepthsAreMultipliedByTheScaleAndImagesStay) {
  Scene scene;
  const std::vector<double> before = scene.SeenByAll();
  scene.map.Apply({scene.All(RandomSimilarity(scene.rng, 4))});
  const std::vector<double> after = scene.SeenByAll();
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool disparity = i % 3 == 2;
    EXPECT_NEAR(after[i], disparity ? before[i] / 4 : before[i], 1e-6);
  }
  EXPECT_EQ(scene.map.Find(KeyFrameId{2})->scale, 4);
  EXPECT_EQ(scene.map.Find(PointId{7})->reference_distance, 20);
}

TEST(Motion, WhatIsKnownRelativeToAKeyFrameFollowsWithItsUnit) {
  Scene scene;
  scene.map.Apply({scene.All({3, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()})});
  // A frame beside keyframe 2, written down in the unit of then.
  const Rigid3 beside = RandomRigid(scene.rng, 0.2, 0.3);
  const KeyFramePose place = scene.map.PlaceOf(KeyFrameId{2});
  const RelativePose frame{beside * Inverse(place.cam_from_world), place.scale};
  const std::vector<double> before = scene.Seen(beside);
  // Keyframe 2 leaves the map, then the one that it hangs on, and then all of it moves.
  scene.map.Apply({edit::RemoveKeyFrame{KeyFrameId{2}}, edit::RemoveKeyFrame{KeyFrameId{1}}});
  scene.map.Apply({scene.All(RandomSimilarity(scene.rng, 0.5))});
  const KeyFramePose now = scene.map.PlaceOf(KeyFrameId{2});
  EXPECT_NEAR(now.scale, 1.5, 1e-12);
  const std::vector<double> after = scene.Seen(ComposePose(now, frame));
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(after[i], i % 3 == 2 ? before[i] / 0.5 : before[i], 1e-6);
  }
}

// A keyframe removed while its parent had another unit than it came to have later.
TEST(Motion, UnitsOfRemovedKeyFramesPassThroughTheirParents) {
  Map map = ChainOfKeyFrames(4);
  map.Apply({edit::RemoveKeyFrame{KeyFrameId{3}}});
  map.Apply({edit::MoveKeyFrames{
      {{KeyFrameId{2}, {2, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()}}}}});
  EXPECT_EQ(map.PlaceOf(KeyFrameId{3}).scale, 2);
  map.Apply({edit::RemoveKeyFrame{KeyFrameId{2}}});
  map.Apply({edit::MoveKeyFrames{
      {{KeyFrameId{1}, {8, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()}}}}});
  EXPECT_EQ(map.PlaceOf(KeyFrameId{2}).scale, 16);
  EXPECT_EQ(map.PlaceOf(KeyFrameId{3}).scale, 16);
}

TEST(Motion, ALandmarkGoesWithTheNewestKeyFrameThatShowsIt) {
  Map map = ChainOfKeyFrames(4);
  map.Apply({edit::AddPoint{PointSeenBy(0, SeenBy(0, 1, 3))},
             edit::AddPoint{PointSeenBy(1, SeenBy(0, 2, 4))}});
  const Eigen::Vector3d shift(0, 1, 0);
  map.Apply({edit::MoveKeyFrames{
      {{KeyFrameId{2}, {1, Eigen::Quaterniond::Identity(), shift}}, {KeyFrameId{9}, {}}}}});
  EXPECT_EQ(map.Find(PointId{0})->position, Eigen::Vector3d(0, 0, 5));
  EXPECT_EQ(map.Find(PointId{1})->position, Eigen::Vector3d(0, 1, 5));
  EXPECT_EQ(map.Find(KeyFrameId{1})->frame.cam_from_world.translation, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(map.Find(KeyFrameId{2})->frame.cam_from_world.translation, Eigen::Vector3d(2, -1, 0));
  map.CheckInvariants();
}

}  // namespace
}  // namespace plumbline
