// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/se3.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/geometry/triangulation.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

constexpr double kPi = std::numbers::pi;

// Rotation vectors of every size that a branch or a cancellation could mind.
std::vector<Eigen::Vector3d> RotationVectors(double max_angle = kPi - 1e-6) {
  std::vector<Eigen::Vector3d> vectors = {Eigen::Vector3d::Zero()};
  Rng rng(1);
  for (const double angle : {1e-12,
                             1e-8,
                             1e-6,
                             0.99e-4,
                             1.01e-4,
                             0.99e-3,
                             1.01e-3,
                             0.99e-2,
                             1.01e-2,
                             0.1,
                             1.0,
                             2.0,
                             3.0,
                             kPi - 1e-3,
                             kPi - 1e-6}) {
    if (angle > max_angle) continue;
    for (int i = 0; i < 3; ++i) vectors.emplace_back(angle * RandomVector<3>(rng).normalized());
  }
  return vectors;
}

// exp([w]x) by the power series, with halving: slow and independent.
Eigen::Matrix3d SeriesRotation(const Eigen::Vector3d& w) {
  const Eigen::Matrix3d A = Skew(w) / 64;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  for (int k = 20; k >= 1; --k) sum = Eigen::Matrix3d::Identity() + A * sum / k;
  for (int i = 0; i < 6; ++i) sum = sum * sum;
  return sum;
}

TEST(So3, ExpIsTheMatrixExponential) {
  for (const Eigen::Vector3d& w : RotationVectors()) {
    EXPECT_LT((ExpSo3(w).toRotationMatrix() - SeriesRotation(w)).norm(), 1e-13) << w.transpose();
  }
}

TEST(So3, LogInvertsExp) {
  for (const Eigen::Vector3d& w : RotationVectors()) {
    EXPECT_LT((LogSo3(ExpSo3(w)) - w).norm(), 1e-14 + 1e-12 * w.norm()) << w.transpose();
  }
}

TEST(So3, LogIsTheSameForBothQuaternionsOfARotation) {
  for (const Eigen::Vector3d& w : RotationVectors()) {
    const Eigen::Quaterniond q = ExpSo3(w);
    const Eigen::Quaterniond opposite(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((LogSo3(opposite) - LogSo3(q)).norm(), 1e-15);
  }
}

TEST(So3, LogOfAHalfTurnHasLengthPi) {
  EXPECT_NEAR(LogSo3(Eigen::Quaterniond(0, 0, 1, 0)).norm(), kPi, 1e-15);
  EXPECT_NEAR(LogSo3(ExpSo3({1.5 * kPi, 0, 0})).x(), -0.5 * kPi, 1e-14);
}

TEST(So3, LeftJacobianIsTheDerivativeOfExp) {
  for (const Eigen::Vector3d& w : RotationVectors()) {
    const Eigen::Quaterniond inverse = ExpSo3(w).conjugate();
    const Eigen::Matrix3d numeric =
        NumericJacobian([&](const Eigen::Vector3d& x) { return LogSo3(ExpSo3(x) * inverse); }, w);
    EXPECT_LT((LeftJacobianSo3(w) - numeric).norm(), 1e-9) << w.transpose();
  }
}

TEST(So3, InverseLeftJacobianInverts) {
  for (const Eigen::Vector3d& w : RotationVectors()) {
    EXPECT_LT((InverseLeftJacobianSo3(w) * LeftJacobianSo3(w) - Eigen::Matrix3d::Identity()).norm(),
              1e-9)
        << w.transpose();
  }
}

TEST(So3, InverseLeftJacobianIsFiniteAtPi) {
  const Eigen::Vector3d w = kPi * Eigen::Vector3d(1, 2, -2) / 3;
  EXPECT_LT((InverseLeftJacobianSo3(w) * LeftJacobianSo3(w) - Eigen::Matrix3d::Identity()).norm(),
            1e-12);
  EXPECT_LT((InverseLeftJacobianSo3(w * (1 - 1e-9)) * LeftJacobianSo3(w * (1 - 1e-9)) -
             Eigen::Matrix3d::Identity())
                .norm(),
            1e-12);
}

TEST(Rigid3, IsAGroupActingOnPoints) {
  Rng rng(2);
  for (int i = 0; i < 50; ++i) {
    const Rigid3 a = RandomRigid(rng);
    const Rigid3 b = RandomRigid(rng);
    const Eigen::Vector3d p = RandomVector<3>(rng);
    EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-14);
    EXPECT_LT((Inverse(a) * (a * p) - p).norm(), 1e-14);
    EXPECT_LT(((a * b).Matrix() - a.Matrix() * b.Matrix()).norm(), 1e-14);
    EXPECT_LT((Rigid3{} * p - p).norm(), 1e-15);
  }
}

TEST(Se3, LogInvertsExp) {
  Rng rng(3);
  for (const Eigen::Vector3d& w : RotationVectors()) {
    Vector6d x;
    x << w, RandomVector<3>(rng, 2);
    EXPECT_LT((LogSe3(ExpSe3(x)) - x).norm(), 1e-11) << x.transpose();
  }
}

TEST(Se3, ExpFollowsAOneParameterGroup) {
  Rng rng(4);
  for (int i = 0; i < 30; ++i) {
    const Vector6d x = RandomVector<6>(rng);
    const Rigid3 whole = ExpSe3(x);
    const Rigid3 parts = ExpSe3(0.3 * x) * ExpSe3(0.7 * x);
    EXPECT_LT((whole.Matrix() - parts.Matrix()).norm(), 1e-13);
  }
}

TEST(Se3, AdjointMovesAPerturbationToTheOtherSide) {
  Rng rng(6);
  for (int i = 0; i < 30; ++i) {
    const Rigid3 T = RandomRigid(rng);
    const Vector6d x = RandomVector<6>(rng, 0.5);
    const Rigid3 left = ExpSe3(Adjoint(T) * x) * T;
    const Rigid3 right = T * ExpSe3(x);
    EXPECT_LT((left.Matrix() - right.Matrix()).norm(), 1e-12);
  }
}

TEST(Interpolate, MeetsBothEndsAndTheMiddle) {
  Rng rng(7);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 a = RandomRigid(rng);
    const Rigid3 b{(a.rotation * ExpSo3(RandomVector<3>(rng, 0.5))).normalized(),
                   RandomVector<3>(rng)};
    EXPECT_LT((Interpolate(a, b, 0).Matrix() - a.Matrix()).norm(), 1e-12);
    EXPECT_LT((Interpolate(a, b, 1).Matrix() - b.Matrix()).norm(), 1e-12);
    const Rigid3 middle = Interpolate(a, b, 0.5);
    EXPECT_LT((middle.translation - 0.5 * (a.translation + b.translation)).norm(), 1e-14);
    EXPECT_NEAR(AngularDistance(a.rotation, middle.rotation),
                0.5 * AngularDistance(a.rotation, b.rotation),
                1e-12);
  }
}

TEST(Interpolate, TakesTheShortWayWhateverTheSignOfTheQuaternion) {
  const Rigid3 a{ExpSo3({0, 0, 0.2}), Eigen::Vector3d::Zero()};
  Rigid3 b{ExpSo3({0, 0, 0.6}), Eigen::Vector3d::Zero()};
  b.rotation.coeffs() *= -1;
  EXPECT_NEAR(LogSo3(Interpolate(a, b, 0.25).rotation).z(), 0.3, 1e-12);
}

TEST(AngularDistance, IsTheAngleOfTheRelativeRotation) {
  const Eigen::Quaterniond a = ExpSo3({0.3, -0.2, 0.9});
  EXPECT_NEAR(AngularDistance(a, a * ExpSo3({0, 1e-9, 0})), 1e-9, 1e-16);
  EXPECT_NEAR(AngularDistance(a, a * ExpSo3({0, 0, 3.0})), 3.0, 1e-12);
  EXPECT_NEAR(AngularDistance(a, a * ExpSo3({0, 0, 4.0})), 2 * kPi - 4.0, 1e-12);
}

TEST(ShortestTurn, TurnsOneDirectionIntoTheOther) {
  Rng rng(3);
  for (const double opposite : {0.0, 1e-9, 1e-7, 1e-5, 1.0}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d from = RandomVector<3>(rng);
      const Eigen::Vector3d to = -from + opposite * from.norm() * RandomVector<3>(rng);
      const Eigen::Quaterniond turn = ShortestTurn(from, to);
      EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-9) << opposite;
      const double between = std::atan2(from.cross(to).norm(), from.dot(to));
      EXPECT_NEAR(LogSo3(turn).norm(), between, 2e-3);
    }
  }
}

}  // namespace

namespace unit_rotation_test {

Eigen::Quaterniond Scaled(double norm) {
  Eigen::Quaterniond q = ExpSo3({0.3, -0.5, 0.2});
  q.coeffs() *= norm;
  return q;
}

TEST(UnitRotation, NormalizesWhatIsOffByLittle) {
  for (const double norm : {0.991, 1.009, 1 + 1e-6}) {
    const Eigen::Quaterniond q = UnitRotation(Scaled(norm), "q");
    EXPECT_LT((q.coeffs() - Scaled(1).coeffs()).norm(), 1e-12) << norm;
  }
  const Eigen::Quaterniond rounded = Scaled(1 + 1e-12);
  EXPECT_EQ(UnitRotation(rounded, "q").coeffs(), rounded.coeffs());
}

TEST(UnitRotation, RefusesAnyOther) {
  for (const double norm : {0.0,
                            0.98,
                            1.02,
                            2.0,
                            std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(IsRotation(Scaled(norm))) << norm;
    EXPECT_THROW(UnitRotation(Scaled(norm), "q"), InputError) << norm;
  }
  EXPECT_EQ(MessageOf([] { UnitRotation(Scaled(2), "q"); }),
            "q: expected a quaternion of norm 1, found one of norm 2");
}

TEST(UnitRotation, NamesThePoseOfATrajectory) {
  Trajectory poses = {{0, {Scaled(1.005), {1, 2, 3}}}, {1, {Scaled(1), {}}}};
  const Trajectory unit = WithUnitRotations(poses, "estimate");
  EXPECT_NEAR(unit[0].world_from_camera.rotation.norm(), 1, 1e-15);
  EXPECT_EQ(unit[0].world_from_camera.translation, poses[0].world_from_camera.translation);
  poses[1].world_from_camera.rotation = Scaled(0.5);
  EXPECT_EQ(MessageOf([&] { WithUnitRotations(poses, "estimate"); }),
            "estimate: pose 1 (from 0): expected a quaternion of norm 1, found one of norm 0.5");
}

TEST(UnitRotation, IsTheRuleOfInterpolation) {
  const Trajectory poses = {{0, {Scaled(1.008), {0, 0, 0}}}, {100, {Scaled(1.008), {1, 0, 0}}}};
  for (const std::int64_t stamp : {0, 50, 100}) {
    const auto pose = InterpolateAt(poses, stamp, 1000);
    ASSERT_TRUE(pose);
    EXPECT_LT(AngularDistance(pose->rotation, Scaled(1)), 1e-7);
    EXPECT_NEAR(pose->rotation.norm(), 1, 1e-12);
  }
  EXPECT_THROW(InterpolateAt({{0, {Scaled(2), {}}}}, 0, 1000), InputError);
}

TEST(UnitRotation, IsTheRuleOfTriangulation) {
  const RectifiedCamera camera{500, 500, 320, 240, 0, 640, 480};
  const auto line_of = [&](double norm) {
    std::vector<LineView> views;
    for (const double x : {0.0, 0.5, 1.0}) {
      LineView view;
      view.cam_from_world.translation = {-x, -0.3 * x, 0};
      const auto pixel = [&](const Eigen::Vector3d& p) {
        return camera.Project(view.cam_from_world * p);
      };
      view.segment = {pixel({-0.5, -1, 4}), pixel({0.4, 1, 5})};
      view.cam_from_world.rotation.coeffs() *= norm;
      views.push_back(view);
    }
    return TriangulateLine(camera, views);
  };
  const auto exact = line_of(1), off = line_of(1.006);
  ASSERT_TRUE(exact);
  ASSERT_TRUE(off);
  EXPECT_LT((off->line.direction - exact->line.direction).norm(), 1e-9);
  EXPECT_THROW(line_of(1.1), InputError);
}

}  // namespace unit_rotation_test

namespace {

TEST(BasisAcross, IsOrthonormal) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d t = RandomVector<3>(rng).normalized();
    Eigen::Matrix3d all;
    all << t, BasisAcross(t);
    EXPECT_LT((all.transpose() * all - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
}

TEST(BasisAcross, IsDefinedAlongTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d t = -Eigen::Vector3d::Unit(axis);
    EXPECT_LT((t.transpose() * BasisAcross(t)).norm(), 1e-15);
  }
}

}  // namespace

}  // namespace plumbline
