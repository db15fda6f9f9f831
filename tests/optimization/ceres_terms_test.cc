// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ceres_terms.h"

#include "plumbline/optimization/local_ba.h"

#include "tests/optimization/ba_scene.h"
#include <array>
#include <limits>

#include <ceres/manifold_test_utils.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using namespace ceres;  // NOLINT: the macro for manifolds uses unqualified names
using plumbline::testing::AddNoise;
using plumbline::testing::MakeBaScene;
using plumbline::testing::MeasureLine;
using plumbline::testing::MeasurePoint;
using plumbline::testing::Random;
using plumbline::testing::StereoCamera;

Vector PoseNumbers(const Rigid3& pose) {
  Vector x(7);
  x << pose.rotation.coeffs(), pose.translation;
  return x;
}

Vector LineNumbers(const OrthonormalLine& line) {
  Vector x(6);
  x << line.U.coeffs(), line.w;
  return x;
}

OrthonormalLine RandomLine(Random& random) {
  return ToOrthonormal(LineThroughPoints(random.NormalVector(2), random.NormalVector(2)));
}

// q and -q are one rotation; the invariants compare numbers, so y is written on the side of x.
Vector OnTheSideOf(const Vector& x, Vector y) {
  if (x.head<4>().dot(y.head<4>()) < 0) y.head<4>() *= -1;
  return y;
}

TEST(LeftRigid3Manifold, ObeysTheInvariantsOfManifolds) {
  Random random(1);
  const LeftRigid3Manifold manifold;
  for (int i = 0; i < 20; ++i) {
    const Vector x = PoseNumbers(ExpSe3(random.Twist(1, 3)));
    const Vector y = OnTheSideOf(x, PoseNumbers(ExpSe3(random.Twist(1, 3))));
    const Vector delta = random.Twist(0.4, 1);
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-6);
  }
}

TEST(LeftRigid3Manifold, PlusIsTheLeftPerturbation) {
  Random random(2);
  const Rigid3 pose = ExpSe3(random.Twist(1, 3));
  const Vector6d delta = random.Twist(0.3, 1);
  Vector out(7);
  LeftRigid3Manifold().Plus(PoseNumbers(pose).data(), delta.data(), out.data());
  EXPECT_LT((out - PoseNumbers(RetractLeft(pose, delta))).norm(), 1e-14);
}

TEST(OrthonormalLineManifold, ObeysTheInvariantsOfManifolds) {
  Random random(3);
  const OrthonormalLineManifold manifold;
  for (int i = 0; i < 20; ++i) {
    const Vector x = LineNumbers(RandomLine(random));
    const Vector y = OnTheSideOf(x, LineNumbers(RandomLine(random)));
    Vector delta(4);
    delta << random.NormalVector(0.3), random.Normal(0.3);
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-6);
  }
}

// Residuals and derivatives in the tangent space of a cost of pose and landmark.
struct Evaluation {
  Vector r;
  Matrix J_pose, J_landmark;
};

Evaluation Evaluate(const ceres::CostFunction& cost,
                    const Vector& pose,
                    const Vector& landmark,
                    const ceres::Manifold* landmark_manifold) {
  const int rows = cost.num_residuals();
  const auto size = static_cast<int>(landmark.size());
  Evaluation out{Vector(rows), {}, {}};
  Matrix J_pose(rows, 7);
  Matrix J_landmark(rows, size);
  const std::array<const double*, 2> x{pose.data(), landmark.data()};
  std::array<double*, 2> jacobians{J_pose.data(), J_landmark.data()};
  EXPECT_TRUE(cost.Evaluate(x.data(), out.r.data(), jacobians.data()));
  Matrix plus_pose(7, 6);
  LeftRigid3Manifold().PlusJacobian(pose.data(), plus_pose.data());
  out.J_pose = J_pose * plus_pose;
  out.J_landmark = J_landmark;
  if (landmark_manifold != nullptr) {
    Matrix plus(size, landmark_manifold->TangentSize());
    landmark_manifold->PlusJacobian(landmark.data(), plus.data());
    out.J_landmark = J_landmark * plus;
  }
  return out;
}

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
    const Vector point = Inverse(pose) * random.PointInView(camera);
    auto m = MeasurePoint(camera, pose, point, i % 2 == 0, 0.8);
    AddNoise(random, 3, m);
    const auto analytic = MakePointCost(camera, m, CeresDerivatives::kAnalytic);
    const auto automatic = MakePointCost(camera, m, CeresDerivatives::kAutomatic);
    ExpectEqual(Evaluate(*analytic, PoseNumbers(pose), point, nullptr),
                Evaluate(*automatic, PoseNumbers(pose), point, nullptr));
  }
}

TEST(CeresTerms, AnalyticDerivativesOfLinesAgreeWithAutomaticOnes) {
  Random random(5);
  const RectifiedCamera camera = StereoCamera();
  const OrthonormalLineManifold manifold;
  for (int i = 0; i < 20; ++i) {
    const Rigid3 pose = ExpSe3(random.Twist(0.5, 2));
    const Segment3 segment{Inverse(pose) * random.PointInView(camera),
                           Inverse(pose) * random.PointInView(camera)};
    auto m = MeasureLine(camera, pose, segment, i % 2 == 0, 1);
    AddNoise(random, 5, m);
    m.covariance << 2, 0.5, 0.5, 1;
    const Vector line = LineNumbers(ToOrthonormal(LineThroughPoints(segment.start, segment.end)));
    const auto analytic = MakeLineCost(camera, m, CeresDerivatives::kAnalytic);
    const auto automatic = MakeLineCost(camera, m, CeresDerivatives::kAutomatic);
    ExpectEqual(Evaluate(*analytic, PoseNumbers(pose), line, &manifold),
                Evaluate(*automatic, PoseNumbers(pose), line, &manifold));
  }
}

LocalBaOptions ToConvergence(bool robust) {
  return {.rounds = 1, .max_iterations = 300, .function_tolerance = 1e-13, .robust = robust};
}

TEST(SolveLocalBa, ReachesTheCostOfCeres) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    for (const bool robust : {false, true}) {
      for (const auto derivatives : {CeresDerivatives::kAnalytic, CeresDerivatives::kAutomatic}) {
        const auto scene = MakeBaScene(
            seed, {.points = 150, .lines = 40, .sigma = 1, .outliers = robust ? 0.05 : 0.0});
        const LocalBaOptions options = ToConvergence(robust);
        const BaResult ours = SolveLocalBa(scene.problem, options);
        const HuberThresholds huber{
            options.huber_point, options.huber_disparity, options.huber_line};
        const auto reference = SolveWithCeres(scene.problem,
                                              {.huber = robust ? huber : HuberThresholds{},
                                               .derivatives = derivatives,
                                               .max_iterations = 300,
                                               .function_tolerance = 1e-13});
        EXPECT_NEAR(ours.initial_cost, reference.initial_cost, 1e-9 * reference.initial_cost);
        EXPECT_NEAR(ours.final_cost, reference.final_cost, 1e-6 * reference.final_cost)
            << "seed " << seed << " robust " << robust << " iterations " << ours.iterations
            << " and " << reference.iterations;
        for (std::size_t i = 0; i < ours.poses.size(); ++i) {
          EXPECT_LT(LogSe3(ours.poses[i] * Inverse(reference.poses[i])).norm(), 1e-3);
        }
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
