// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/sim3.h"

#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Tangents with small, zero and large rotation and log scale in all combinations.
std::vector<Vector7d> Tangents() {
  Rng rng(1);
  std::vector<Vector7d> tangents;
  for (const double angle : {0.0, 1e-8, 1e-4, 0.3, 2.0, 3.1}) {
    for (const double log_scale : {0.0, 1e-9, -1e-4, 0.4, -2.0, 3.0}) {
      Vector7d x;
      x << angle * RandomVector<3>(rng).normalized(), RandomVector<3>(rng), log_scale;
      tangents.push_back(x);
    }
  }
  return tangents;
}

// The matrix exponential of the 4 x 4 form, by series and squaring.
Eigen::Matrix4d SeriesExponential(const Vector7d& x) {
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topLeftCorner<3, 3>() = Skew(x.head<3>()) + x(6) * Eigen::Matrix3d::Identity();
  A.topRightCorner<3, 1>() = x.segment<3>(3);
  A /= 64;
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
  for (int k = 20; k >= 1; --k) sum = Eigen::Matrix4d::Identity() + A * sum / k;
  for (int i = 0; i < 6; ++i) sum = sum * sum;
  return sum;
}

TEST(Similarity3, IsAGroupActingOnPoints) {
  Rng rng(2);
  const std::vector<Vector7d> tangents = Tangents();
  for (std::size_t i = 1; i < tangents.size(); ++i) {
    const Similarity3 a = ExpSim3(tangents[i]);
    const Similarity3 b = ExpSim3(tangents[i - 1]);
    const Eigen::Vector3d p = RandomVector<3>(rng);
    const double size = 1 + a.scale * (b.scale + b.translation.norm()) + a.translation.norm();
    EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-13 * size);
    EXPECT_LT((Inverse(a) * (a * p) - p).norm(), 1e-12 * size / a.scale);
    EXPECT_LT(((a * b).Matrix() - a.Matrix() * b.Matrix()).norm(), 1e-12 * size);
  }
}

TEST(Sim3, ExpIsTheMatrixExponential) {
  for (const Vector7d& x : Tangents()) {
    const Eigen::Matrix4d expected = SeriesExponential(x);
    EXPECT_LT((ExpSim3(x).Matrix() - expected).norm(), 1e-12 * expected.norm()) << x.transpose();
  }
}

TEST(Sim3, LogInvertsExp) {
  for (const Vector7d& x : Tangents()) {
    EXPECT_LT((LogSim3(ExpSim3(x)) - x).norm(), 1e-11) << x.transpose();
  }
}

TEST(Sim3, IsSe3AtScaleOne) {
  for (Vector7d x : Tangents()) {
    x(6) = 0;
    const Rigid3 rigid = ExpSe3(x.head<6>());
    EXPECT_LT((ExpSim3(x).Matrix() - rigid.Matrix()).norm(), 1e-13);
    EXPECT_EQ((Adjoint(ToSimilarity(rigid)).topLeftCorner<6, 6>() - Adjoint(rigid)).norm(), 0);
  }
}

TEST(Sim3, AdjointMovesAPerturbationToTheOtherSide) {
  Rng rng(3);
  for (const Vector7d& at : Tangents()) {
    const Similarity3 S = ExpSim3(at);
    const Vector7d x = RandomVector<7>(rng, 0.1);
    const Eigen::Matrix4d left = (ExpSim3(Adjoint(S) * x) * S).Matrix();
    const Eigen::Matrix4d right = (S * ExpSim3(x)).Matrix();
    EXPECT_LT((left - right).norm(), 1e-11 * right.norm());
  }
}

TEST(Sim3, JacobiansAreTheDerivativesOfExpAndLog) {
  for (const Vector7d& x : Tangents()) {
    if (x.head<3>().norm() > 3) continue;
    const Similarity3 S = ExpSim3(x);
    const Similarity3 inverse = Inverse(S);
    const Matrix7d left =
        NumericJacobian([&](const Vector7d& y) { return LogSim3(ExpSim3(y) * inverse); }, x);
    EXPECT_LT((LeftJacobianSim3(x) - left).norm(), 1e-8 * (1 + left.norm())) << x.transpose();
    const Matrix7d of_log = NumericJacobian(
        [&](const Vector7d& d) { return LogSim3(RetractLeft(S, d)); }, Vector7d(Vector7d::Zero()));
    EXPECT_LT((InverseLeftJacobianSim3(x) - of_log).norm(), 1e-8 * (1 + of_log.norm()))
        << x.transpose();
  }
}

TEST(TransformPose, MovesTheCentreAndTurnsTheAxes) {
  Rng rng(4);
  const Similarity3 S = ExpSim3(RandomVector<7>(rng));
  const Rigid3 world_from_cam = RandomRigid(rng);
  const Rigid3 moved = TransformPose(S, world_from_cam);
  EXPECT_LT((moved.translation - S * world_from_cam.translation).norm(), 1e-14);
  // A point ahead of the camera by z is ahead by z * scale in the new world.
  const Eigen::Vector3d point = world_from_cam * Eigen::Vector3d(0.1, 0.2, 3);
  EXPECT_LT((Inverse(moved) * (S * point) - S.scale * Eigen::Vector3d(0.1, 0.2, 3)).norm(), 1e-13);
}

}  // namespace
}  // namespace plumbline
