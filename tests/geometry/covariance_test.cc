// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/covariance.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(LargestSigma, IsThatOfTheLongestAxisHoweverTheEllipsoidIsTurned) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d variances(0.04, 9, 1e-6);
  EXPECT_NEAR(LargestSigma(R * variances.asDiagonal() * R.transpose()), 3, 1e-12);
}

TEST(LargestSigma, IsZeroWhereNothingIsUncertain) {
  EXPECT_EQ(LargestSigma(Eigen::Matrix3d::Zero()), 0);
}

TEST(LargestSigma, IsInfiniteWhereACovarianceIsNotKnown) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  covariance(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(LargestSigma(covariance)));
  covariance(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isinf(LargestSigma(covariance)));
}

Matrix6d ACovariance() {
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = std::sin(1.0 + 7 * i);
  return root * root.transpose() + 0.1 * Matrix6d::Identity();
}

Rigid3 APose() {
  Vector6d tangent;
  tangent << 0.4, -1.1, 0.8, 3, -2, 5;
  return ExpSe3(tangent);
}

// The error of an estimated pose as PoseCovarianceInWorld means it.
Vector6d ErrorInWorld(const Rigid3& true_cam_from_world, const Rigid3& cam_from_world) {
  const Rigid3 truth = Inverse(true_cam_from_world), estimate = Inverse(cam_from_world);
  Vector6d error;
  error << truth.translation - estimate.translation,
      LogSo3(truth.rotation * estimate.rotation.conjugate());
  return error;
}

TEST(PoseCovarianceInWorld, IsThatOfTheCentreAndOfTheTurnAboutTheAxesOfTheWorld) {
  const Rigid3 pose = APose();
  constexpr double kStep = 1e-6;
  Matrix6d J;
  for (int i = 0; i < 6; ++i) {
    J.col(i) = ErrorInWorld(RetractLeft(pose, kStep * Vector6d::Unit(i)), pose) / kStep;
  }
  const Matrix6d expected = J * ACovariance() * J.transpose();
  const Matrix6d found = PoseCovarianceInWorld(pose, ACovariance());
  EXPECT_LT((found - expected).norm(), 1e-4 * expected.norm());
  EXPECT_EQ(found, Matrix6d(found.transpose()));
}

TEST(PoseCovarianceInWorld, TurnsWithTheWorldAndIsOfNoPlaceInIt) {
  Vector6d motion;
  motion << 0.9, 0.3, -0.5, 40, 70, -20;
  const Rigid3 other_from_world = ExpSe3(motion);
  const Matrix6d there = PoseCovarianceInWorld(APose() * Inverse(other_from_world), ACovariance());
  const Matrix6d here = PoseCovarianceInWorld(APose(), ACovariance());
  const Matrix6d turned =
      MovedPoseCovariance(here, other_from_world.rotation, Eigen::Vector3d::Zero());
  EXPECT_LT((there - turned).norm(), 1e-10 * turned.norm());
}

TEST(PoseCovarianceInWorld, DoesNotDependOnHowTheImageIsTurned) {
  const Rigid3 turned_from_camera{ExpSo3({0.1, -0.7, 0.2}), Eigen::Vector3d::Zero()};
  const Matrix6d adjoint = Adjoint(turned_from_camera);
  const Matrix6d turned = PoseCovarianceInWorld(turned_from_camera * APose(),
                                                adjoint * ACovariance() * adjoint.transpose());
  const Matrix6d as_is = PoseCovarianceInWorld(APose(), ACovariance());
  EXPECT_LT((turned - as_is).norm(), 1e-10 * as_is.norm());
}

TEST(MovedPoseCovariance, OfABodyOnTheCameraGrowsWithTheLever) {
  // Known but for the turn about z: a body 2 m along x moves along y.
  Matrix6d turn_only = Matrix6d::Zero();
  turn_only(5, 5) = 0.01;
  const Matrix6d moved = MovedPoseCovariance(turn_only, Eigen::Quaterniond::Identity(), {2, 0, 0});
  Matrix6d expected = turn_only;
  expected(1, 1) = 0.04;
  expected(1, 5) = expected(5, 1) = 0.02;
  EXPECT_LT((moved - expected).norm(), 1e-15);
}

}  // namespace
}  // namespace plumbline
