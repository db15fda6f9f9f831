// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ba_terms.h"

#include "tests/optimization/random_scene.h"
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::AddNoise;
using testing::MeasureLine;
using testing::MeasurePoint;
using testing::Random;
using testing::RandomMeasuredSegment;
using testing::StereoCamera;

// The blocks that one observation adds, each expected to be w J^T J or w J^T r.
template <int kDof>
struct Blocks {
  LandmarkEquations<kDof> landmark;
  PoseEquations pose;
  Eigen::Matrix<double, 6, kDof> W = Eigen::Matrix<double, 6, kDof>::Zero();
};

template <int kDof, class JPose, class JLandmark, class Residual>
void ExpectBlocks(const Blocks<kDof>& blocks,
                  const JPose& J_pose,
                  const JLandmark& J_landmark,
                  const Residual& r,
                  double w,
                  double tolerance = 1e-10) {
  const auto lower = [](const auto& m) {
    return Eigen::MatrixXd(Eigen::MatrixXd(m).triangularView<Eigen::Lower>());
  };
  const auto near = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LT((a - b).norm(), tolerance * (1 + b.norm())) << a << "\nexpected\n" << b;
  };
  near(lower(blocks.pose.H), lower(w * J_pose.transpose() * J_pose));
  near(blocks.pose.g, w * J_pose.transpose() * r);
  near(lower(blocks.landmark.V), lower(w * J_landmark.transpose() * J_landmark));
  near(blocks.landmark.g, w * J_landmark.transpose() * r);
  near(blocks.W, w * J_pose.transpose() * J_landmark);
}

BaPose PoseAt(const Rigid3& cam_from_world) {
  BaPose pose;
  pose.Set(cam_from_world);
  return pose;
}

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

// The derivative with respect to the left turn, by central differences.
TEST(BaLineLeft, AddsTheProductsOfTheJacobiansByCentralDifferences) {
  Random random(5);
  const RectifiedCamera camera = StereoCamera();
  for (int i = 0; i < 20; ++i) {
    const auto [cam_from_world, segment, m] = RandomMeasuredSegment(random, i % 2 == 0);
    const BaPose pose = PoseAt(cam_from_world);
    const auto line = ToOrthonormal(LineThroughPoints(segment.start, segment.end));
    const auto full = EvaluateLine(camera, pose.cam_from_world, line, m);
    ASSERT_TRUE(full);
    Eigen::Matrix<double, 2, 4> J_left;
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(k);
      const auto above = EvaluateLine(camera, pose.cam_from_world, RetractLeft(line, step), m);
      const auto below = EvaluateLine(camera, pose.cam_from_world, RetractLeft(line, -step), m);
      J_left.col(k) = (above->r - below->r) / (2 * kStep);
    }
    const LineTerm term = MakeLineTerm(camera, m);
    const double huber = 2;
    Blocks<4> blocks;
    const BaLineLeft::Target target{blocks.landmark, &blocks.pose, &blocks.W};
    ASSERT_TRUE(BaLineLeft::Add(camera, pose, BaLineLeft::MakeView(line), term, huber, target));
    ExpectBlocks(
        blocks, full->J_pose, J_left, full->r, HuberWeight(full->r.squaredNorm(), huber), 1e-6);
  }
}

std::optional<LineResidual> EvaluateEnds(const RectifiedCamera& camera,
                                         const BaPose& pose,
                                         const Segment3& ends,
                                         const LineMeasurement& m) {
  const auto line = ToOrthonormal(LineThroughPoints(ends.start, ends.end));
  return EvaluateLine(camera, pose.cam_from_world, line, m);
}

TEST(BaLineEnds, AddsTheProductsOfTheJacobiansByCentralDifferences) {
  Random random(3);
  const RectifiedCamera camera = StereoCamera();
  for (int i = 0; i < 20; ++i) {
    const auto [cam_from_world, ends, m] = RandomMeasuredSegment(random, i % 2 == 0);
    const BaPose pose = PoseAt(cam_from_world);
    const auto full = EvaluateEnds(camera, pose, ends, m);
    ASSERT_TRUE(full);
    Eigen::Matrix<double, 2, 6> J_ends;
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = kStep * Vector6d::Unit(k);
      const auto above = EvaluateEnds(camera, pose, BaLineEnds::Retract(ends, step), m);
      const auto below = EvaluateEnds(camera, pose, BaLineEnds::Retract(ends, -step), m);
      J_ends.col(k) = (above->r - below->r) / (2 * kStep);
    }
    const LineTerm term = MakeLineTerm(camera, m);
    const double huber = 2;
    Blocks<6> blocks;
    const BaLineEnds::Target target{blocks.landmark, &blocks.pose, &blocks.W};
    const BaLineEnds::View view = BaLineEnds::MakeView(ends);
    ASSERT_TRUE(BaLineEnds::Add(camera, pose, view, term, huber, target));
    const double chi2 = full->r.squaredNorm();
    ExpectBlocks(blocks, full->J_pose, J_ends, full->r, HuberWeight(chi2, huber), 1e-6);
    EXPECT_NEAR(BaLineEnds::Chi2(camera, pose, view, term), chi2, 1e-9 * chi2);
  }
}

// Equations of a line seen from six poses.
LandmarkEquations<6> EndsEquations(Random& random, const Segment3& ends) {
  const RectifiedCamera camera = StereoCamera();
  LandmarkEquations<6> equations;
  for (int i = 0; i < 6; ++i) {
    BaPose pose;
    pose.Set(ExpSe3(random.Twist(0.05, 0.3)));
    auto m = MeasureLine(camera, pose.cam_from_world, ends, false, 1);
    AddNoise(random, 1, m);
    BaLineEnds::Add(camera,
                    pose,
                    BaLineEnds::MakeView(ends),
                    MakeLineTerm(camera, m),
                    3,
                    {equations, nullptr, nullptr});
  }
  equations.V = equations.V.selfadjointView<Eigen::Lower>();
  return equations;
}

TEST(BaLineEnds, HoldsSlidingEndsAndNothingElse) {
  Random random(4);
  // Along an axis, too: there a coordinate of its own is free.
  for (const Segment3& ends : {Segment3{{-1, 0.2, 6}, {1.5, 0.8, 7}},
                               Segment3{{-1, 0.5, 5}, {2, 0.5, 5}},
                               Segment3{{0.3, -1, 5}, {0.3, 1, 5}}}) {
    const LandmarkEquations<6> equations = EndsEquations(random, ends);
    const Eigen::Vector3d along = (ends.end - ends.start).normalized();
    for (const bool start : {true, false}) {
      Vector6d slide = Vector6d::Zero();
      slide.segment<3>(start ? 0 : 3) = along;
      EXPECT_LT((equations.V * slide).norm(), 1e-9 * equations.V.norm());
      EXPECT_LT(std::abs(equations.g.dot(slide)), 1e-9 * equations.g.norm());
    }
    LandmarkEquations<6> held = equations;
    BaLineEnds::HoldGauge(BaLineEnds::MakeView(ends), held);
    held.V = held.V.selfadjointView<Eigen::Lower>();
    const Vector6d step = held.V.llt().solve(equations.g);
    const Vector6d shortest = equations.V.completeOrthogonalDecomposition().solve(equations.g);
    EXPECT_LT((step - shortest).norm(), 1e-6 * shortest.norm());
    EXPECT_LT(std::abs(step.head<3>().dot(along)), 1e-8 * step.norm());
    EXPECT_LT(std::abs(step.tail<3>().dot(along)), 1e-8 * step.norm());
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
