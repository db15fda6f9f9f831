// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ba_terms.h"

#include "tests/optimization/ba_blocks.h"
#include "tests/optimization/random_scene.h"
#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::AddNoise;
using testing::Blocks;
using testing::ExpectBlocks;
using testing::MeasurePoint;
using testing::PoseAt;
using testing::Random;
using testing::RandomMeasuredSegment;
using testing::StereoCamera;

BaPose RandomPose(Random& random) { return PoseAt(ExpSe3(random.Twist(0.7, 2))); }

TEST(BaPoint, AddsTheProductsOfTheJacobians) {
  Random random(1);
  const RectifiedCamera camera = StereoCamera();
  for (int i = 0; i < 20; ++i) {
    const BaPose pose = RandomPose(random);
    const Eigen::Vector3d point = Inverse(pose.cam_from_world) * random.PointInView(camera);
    auto m = MeasurePoint(camera, pose.cam_from_world, point, i % 2 == 0, 0.8);
    AddNoise(random, 4, m);
    const auto full = EvaluatePoint(camera, pose.cam_from_world, point, m);
    ASSERT_TRUE(full);
    const double huber = 2;
    Blocks<3> blocks;
    const BaPoint::Target target{blocks.landmark, &blocks.pose, &blocks.W};
    ASSERT_TRUE(BaPoint::Add(camera, pose, point, MakePointTerm(m), huber, target));
    const double chi2 = full->r.squaredNorm();
    ExpectBlocks(blocks, full->J_pose, full->J_point, full->r, HuberWeight(chi2, huber));
    EXPECT_NEAR(BaPoint::Chi2(camera, pose, point, MakePointTerm(m)), chi2, 1e-9 * chi2);
  }
}

TEST(BaLine, AddsTheProductsOfTheJacobians) {
  Random random(2);
  const RectifiedCamera camera = StereoCamera();
  for (int i = 0; i < 20; ++i) {
    const auto [cam_from_world, segment, m] = RandomMeasuredSegment(random, i % 2 == 0);
    const BaPose pose = PoseAt(cam_from_world);
    const auto line = ToOrthonormal(LineThroughPoints(segment.start, segment.end));
    const auto full = EvaluateLine(camera, pose.cam_from_world, line, m);
    ASSERT_TRUE(full);
    const LineTerm term = MakeLineTerm(camera, m);
    const double huber = 2;
    Blocks<4> blocks;
    const BaLine::Target target{blocks.landmark, &blocks.pose, &blocks.W};
    ASSERT_TRUE(BaLine::Add(camera, pose, BaLine::MakeView(line), term, huber, target));
    const double chi2 = full->r.squaredNorm();
    ExpectBlocks(blocks, full->J_pose, full->J_line, full->r, HuberWeight(chi2, huber));
    EXPECT_NEAR(BaLine::Chi2(camera, pose, BaLine::MakeView(line), term), chi2, 1e-9 * chi2);
  }
}

TEST(BaPoint, AFixedPoseGetsNothing) {
  const RectifiedCamera camera = StereoCamera();
  const BaPose pose;
  const Eigen::Vector3d point(0.1, 0.2, 4);
  auto m = MeasurePoint(camera, {}, point, true, 1);
  Blocks<3> blocks;
  EXPECT_TRUE(
      BaPoint::Add(camera, pose, point, MakePointTerm(m), 1, {blocks.landmark, nullptr, nullptr}));
  EXPECT_GT(blocks.landmark.V.trace(), 0);
}

TEST(BaPoint, BehindTheCameraAddsNothingAndCostsInfinitelyMuch) {
  const BaPose pose;
  Blocks<3> blocks;
  const BaPoint::Target target{blocks.landmark, &blocks.pose, &blocks.W};
  EXPECT_FALSE(BaPoint::Add(StereoCamera(), pose, {0, 0, -1}, {}, 1, target));
  EXPECT_EQ(blocks.landmark.V.norm() + blocks.pose.H.norm() + blocks.W.norm(), 0);
  EXPECT_TRUE(std::isinf(BaPoint::Chi2(StereoCamera(), pose, {0, 0, -1}, {})));
}

}  // namespace
}  // namespace plumbline
