// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_terms.h"

#include "lab/ceres_reference/ceres_manifolds.h"
#include "plumbline/tracking/projected_ends.h"

#include "tests/lab/ceres_reference/ceres_numbers.h"
#include "tests/optimization/random_scene.h"
#include <array>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::VectorXd;
using plumbline::testing::AddNoise;
using plumbline::testing::LineNumbers;
using plumbline::testing::MeasuredSegment;
using plumbline::testing::MeasurePoint;
using plumbline::testing::PoseNumbers;
using plumbline::testing::Random;
using plumbline::testing::RandomMeasuredSegment;
using plumbline::testing::StereoCamera;

// As Ceres writes derivatives.
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Residuals and derivatives in the tangent space of a cost of pose and landmark.
struct Evaluation {
  VectorXd r;
  Matrix J_pose, J_landmark;
};

Evaluation Evaluate(const ceres::CostFunction& cost,
                    const VectorXd& pose,
                    const VectorXd& landmark,
                    const ceres::Manifold& pose_manifold,
                    const ceres::Manifold& landmark_manifold) {
  const int rows = cost.num_residuals();
  const auto size = static_cast<int>(landmark.size());
  Matrix J_pose(rows, 7);
  Matrix J_landmark(rows, size);
  Evaluation out{VectorXd(rows), Matrix(rows, 6), Matrix(rows, landmark_manifold.TangentSize())};
  const std::array<const double*, 2> x{pose.data(), landmark.data()};
  std::array<double*, 2> jacobians{J_pose.data(), J_landmark.data()};
  EXPECT_TRUE(cost.Evaluate(x.data(), out.r.data(), jacobians.data()));
  pose_manifold.RightMultiplyByPlusJacobian(pose.data(), rows, J_pose.data(), out.J_pose.data());
  landmark_manifold.RightMultiplyByPlusJacobian(
      landmark.data(), rows, J_landmark.data(), out.J_landmark.data());
  return out;
}

const TangentManifold<LeftRigid3Manifold> kTangentPose;
const LeftRigid3Manifold kPose;

void ExpectEqual(const Evaluation& a, const Evaluation& b) {
  EXPECT_LT((a.r - b.r).norm(), 1e-8);
  EXPECT_LT((a.J_pose - b.J_pose).norm(), 1e-9 * b.J_pose.norm());
  EXPECT_LT((a.J_landmark - b.J_landmark).norm(), 1e-9 * b.J_landmark.norm());
}

TEST(CeresTerms, AnalyticDerivativesOfPointsAgreeWithAutomaticOnes) {
  Random random(4);
  const RectifiedCamera camera = StereoCamera();
  for (int i = 0; i < 20; ++i) {
    const Rigid3 pose = ExpSe3(random.Twist(0.5, 2));
    const VectorXd point = Inverse(pose) * random.PointInView(camera);
    auto m = MeasurePoint(camera, pose, point, i % 2 == 0, 0.8);
    AddNoise(random, 3, m);
    const auto analytic = MakePointCost(camera, m, CeresDerivatives::kAnalytic);
    const auto automatic = MakePointCost(camera, m, CeresDerivatives::kAutomatic);
    const ceres::EuclideanManifold<3> manifold;
    ExpectEqual(Evaluate(*analytic, PoseNumbers(pose), point, kTangentPose, manifold),
                Evaluate(*automatic, PoseNumbers(pose), point, kPose, manifold));
  }
}

template <class Manifold>
void ExpectAnalyticIsAutomatic(unsigned seed, LineParametrization lines) {
  Random random(seed);
  for (int i = 0; i < 20; ++i) {
    const MeasuredSegment s = RandomMeasuredSegment(random, i % 2 == 0);
    const VectorXd line =
        LineNumbers(ToOrthonormal(LineThroughPoints(s.segment.start, s.segment.end)));
    const auto analytic = MakeLineCost(StereoCamera(), s.m, CeresDerivatives::kAnalytic, lines);
    const auto automatic = MakeLineCost(StereoCamera(), s.m, CeresDerivatives::kAutomatic, lines);
    const TangentManifold<Manifold> tangent;
    const Manifold manifold;
    ExpectEqual(Evaluate(*analytic, PoseNumbers(s.cam_from_world), line, kTangentPose, tangent),
                Evaluate(*automatic, PoseNumbers(s.cam_from_world), line, kPose, manifold));
  }
}

TEST(CeresTerms, AnalyticDerivativesOfPluckerLinesAgreeWithAutomaticOnes) {
  ExpectAnalyticIsAutomatic<OrthonormalLineManifold>(5, LineParametrization::kPlucker);
}

TEST(CeresTerms, AnalyticDerivativesOfLeftPluckerLinesAgreeWithAutomaticOnes) {
  ExpectAnalyticIsAutomatic<LeftOrthonormalLineManifold>(8, LineParametrization::kPluckerLeft);
}

// The terms of projected ends have automatic derivatives alone; our own are held against them.
TEST(CeresTerms, ProjectedEndsAreThoseOfEvaluateProjectedEnds) {
  Random random(9);
  for (int i = 0; i < 20; ++i) {
    const MeasuredSegment s = RandomMeasuredSegment(random, i % 2 == 0);
    const PluckerLine plucker = LineThroughPoints(s.segment.start, s.segment.end);
    const OrthonormalLine line = ToOrthonormal(plucker);
    const LineInterval interval{plucker.ParameterOf(s.segment.start),
                                plucker.ParameterOf(s.segment.end)};
    const auto cost =
        MakeProjectedEndsCost(StereoCamera(), s.m, LineParametrization::kPlucker, interval);
    const auto ours = EvaluateProjectedEnds(StereoCamera(), s.cam_from_world, line, interval, s.m);
    ASSERT_TRUE(ours);
    const OrthonormalLineManifold manifold;
    ExpectEqual({ours->r, ours->J_pose, ours->J_line},
                Evaluate(*cost, PoseNumbers(s.cam_from_world), LineNumbers(line), kPose, manifold));
  }
}

TEST(CeresTerms, AnalyticDerivativesOfEndPointsAgreeWithAutomaticOnes) {
  Random random(6);
  const auto lines = LineParametrization::kEndpoints;
  for (int i = 0; i < 20; ++i) {
    const MeasuredSegment s = RandomMeasuredSegment(random, i % 2 == 0);
    VectorXd ends(6);
    ends << s.segment.start, s.segment.end;
    const auto analytic = MakeLineCost(StereoCamera(), s.m, CeresDerivatives::kAnalytic, lines);
    const auto automatic = MakeLineCost(StereoCamera(), s.m, CeresDerivatives::kAutomatic, lines);
    const ceres::EuclideanManifold<6> manifold;
    ExpectEqual(Evaluate(*analytic, PoseNumbers(s.cam_from_world), ends, kTangentPose, manifold),
                Evaluate(*automatic, PoseNumbers(s.cam_from_world), ends, kPose, manifold));
  }
}

}  // namespace
}  // namespace plumbline
