// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/absolute_pose.h"

#include "plumbline/base/random.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const RectifiedCamera kCamera{
    .fx = 400, .fy = 410, .cx = 320, .cy = 240, .baseline = 0.1, .width = 640, .height = 480};

const Rigid3 kPose{ExpSo3({0.3, -0.4, 0.2}), {0.5, -1, 2}};

// Points before the camera, seen with half a pixel of noise; the last `wrong` of them elsewhere.
std::vector<PointInImage> Sightings(int count, int wrong, double noise_px = 0.5) {
  Rng rng(1, "absolute_pose");
  std::vector<PointInImage> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d px(rng.Uniform(20, 620), rng.Uniform(20, 460));
    const double z = rng.Uniform(1, 6);
    const Eigen::Vector3d in_camera(
        (px.x() - kCamera.cx) / kCamera.fx * z, (px.y() - kCamera.cy) / kCamera.fy * z, z);
    const Eigen::Vector2d noise(rng.Normal(noise_px), rng.Normal(noise_px));
    const Eigen::Vector2d elsewhere(rng.Uniform(0, 640), rng.Uniform(0, 480));
    points.push_back({Inverse(kPose) * in_camera, i < count - wrong ? px + noise : elsewhere});
  }
  return points;
}

double AngleTo(const Rigid3& pose) { return pose.rotation.angularDistance(kPose.rotation); }

TEST(PoseFromPoints, IsExactForExactPoints) {
  const auto pose = PoseFromPoints(kCamera, Sightings(20, 0, 0), 4);
  ASSERT_TRUE(pose);
  EXPECT_LT(AngleTo(*pose), 1e-6);
  EXPECT_LT((pose->translation - kPose.translation).norm(), 1e-5);
}

TEST(PoseFromPoints, IsThatOfTheThirdThatAgrees) {
  const auto pose = PoseFromPoints(kCamera, Sightings(60, 40), 4);
  ASSERT_TRUE(pose);
  EXPECT_LT(AngleTo(*pose), 0.01);
  EXPECT_LT((pose->translation - kPose.translation).norm(), 0.03);
}

TEST(PoseFromPoints, IsTheSameEveryTime) {
  const auto points = Sightings(60, 40);
  const auto a = PoseFromPoints(kCamera, points, 4);
  const auto b = PoseFromPoints(kCamera, points, 4);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->rotation.coeffs(), b->rotation.coeffs());
  EXPECT_EQ(a->translation, b->translation);
}

TEST(PoseFromPoints, IsNoneWithFewerThanSixThatAgree) {
  EXPECT_FALSE(PoseFromPoints(kCamera, {}, 4));
  EXPECT_FALSE(PoseFromPoints(kCamera, Sightings(5, 0), 4));
  EXPECT_FALSE(PoseFromPoints(kCamera, Sightings(40, 36), 4));
}

TEST(PoseFromPoints, IsNoneOfOnePlaceSeenManyTimes) {
  EXPECT_FALSE(PoseFromPoints(kCamera, std::vector(20, Sightings(1, 0)[0]), 4));
}

}  // namespace
}  // namespace plumbline
