// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/ba_rival_lines.h"

#include "tests/optimization/ba_blocks.h"
#include "tests/optimization/random_scene.h"
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::AddNoise;
using testing::Blocks;
using testing::ExpectBlocks;
using testing::MeasureLine;
using testing::PoseAt;
using testing::Random;
using testing::RandomMeasuredSegment;
using testing::StereoCamera;

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

}  // namespace
}  // namespace plumbline
