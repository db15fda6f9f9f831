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

using testing::Random;

constexpr double kSigma = 1.0 / 30;
constexpr double kHuber = 2;

OrthonormalLine RandomLine(Random& random) {
  const Segment3 ends{random.NormalVector(3), random.NormalVector(3)};
  return ToOrthonormal(LineThroughPoints(ends.start, ends.end));
}

// Part of a line's unit direction across the axis, in units of sigma.
Eigen::Vector3d Across(const OrthonormalLine& line, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d d = BaLine::MakePlace(line).direction.normalized();
  return (d - axis * axis.dot(d)) / kSigma;
}

// The equations depend on what is across the axis alone, not on how its two components are chosen.
TEST(BaParallelLines, AddTheProductsOfTheJacobiansByCentralDifferences) {
  constexpr double kStep = 1e-6;
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    BaProblem problem;
    problem.lines = {RandomLine(random), RandomLine(random)};
    problem.axes = {random.NormalVector(3).normalized(), random.NormalVector(3).normalized()};
    problem.parallel_lines = {{1, 1, kSigma}};
    const BaParallelLines parallel(problem);
    const OrthonormalLine& line = problem.lines[1];
    const Eigen::Vector3d& axis = problem.axes[1];
    Eigen::Matrix<double, 3, 4> J;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(k);
      J.col(k) =
          (Across(Retract(line, step), axis) - Across(Retract(line, -step), axis)) / (2 * kStep);
    }
    const Eigen::Vector3d r = Across(line, axis);
    const double w = HuberWeight(r.squaredNorm(), kHuber);
    const BaLine::View view = BaLine::MakeView(line);
    LandmarkEquations<4> equations;
    parallel.Add(1, view.direction, view.J, kHuber, equations);
    const Eigen::Matrix4d V = w * J.transpose() * J;
    EXPECT_LT((equations.V - V).norm(), 1e-6 * V.norm());
    EXPECT_LT((equations.g - w * J.transpose() * r).norm(), 1e-6 * (1 + r.norm() * V.norm()));
    EXPECT_NEAR(parallel.Loss(1, -3 * view.direction, kHuber),
                HuberLoss(r.squaredNorm(), kHuber),
                1e-9 * r.squaredNorm());
    LandmarkEquations<4> of_another;
    parallel.Add(0, view.direction, view.J, kHuber, of_another);
    EXPECT_EQ(of_another.V.norm(), 0);
    EXPECT_EQ(parallel.Loss(0, view.direction, kHuber), 0);
  }
}

TEST(BaParallelLines, CountWhileTheyAreWithinTheLimit) {
  BaProblem problem;
  problem.lines = {ToOrthonormal(LineThroughPoints({0, 0, 2}, {1, 0, 2}))};
  problem.axes = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  problem.parallel_lines = {{1, 0, 0.1}, {0, 0, 0.1}};
  BaParallelLines parallel(problem);
  EXPECT_EQ(parallel.used(), 2U);
  const Eigen::Vector3d near_x(std::cos(0.1), std::sin(0.1), 0);
  parallel.UpdateChi2(0, near_x);
  EXPECT_TRUE(parallel.Classify());
  EXPECT_EQ(parallel.used(), 1U);
  EXPECT_NEAR(parallel.Loss(0, near_x, 100), 1, 0.01);
  EXPECT_FALSE(parallel.Classify());
  parallel.UpdateChi2(0, Eigen::Vector3d::UnitY());
  EXPECT_TRUE(parallel.Classify());
  EXPECT_NEAR(parallel.Loss(0, Eigen::Vector3d::UnitY(), 100), 0, 1e-20);  // the other one
  parallel.UseAll();
  EXPECT_EQ(parallel.used(), 2U);
}

}  // namespace

}  // namespace plumbline
