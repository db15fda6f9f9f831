// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/motion_model.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kFrameSeconds = 0.05;  // seconds

// Metres a second to the right, and a slow turn about the vertical.
Vector6d Velocity() { return (Vector6d() << 0, 0.2, 0, 1, 0, 0).finished(); }

PoseEstimate EstimateAt(const Rigid3& pose) {
  PoseEstimate estimate;
  estimate.cam_from_world = pose;
  estimate.information = 1e6 * Matrix6d::Identity();
  estimate.scene_depth = 4;
  return estimate;
}

double Distance(const Rigid3& a, const Rigid3& b) { return LogSe3(a * Inverse(b)).norm(); }

TEST(MotionModel, StaysWhereTheMotionIsNotKnown) {
  const Rigid3 pose = ExpSe3(Velocity());
  const PosePrior prior = MotionModel().Predict(pose, kFrameSeconds);
  EXPECT_LT(Distance(prior.cam_from_world, pose), 1e-12);
  EXPECT_TRUE(prior.information.isZero());
}

TEST(MotionModel, GoesOnWithTheVelocityOverFramesThatAreMissing) {
  MotionModel motion;
  const Rigid3 first;
  const Rigid3 second = RetractLeft(first, kFrameSeconds * Velocity());
  motion.Observe(first, EstimateAt(second), kFrameSeconds);
  ASSERT_TRUE(motion.IsKnown());
  const Rigid3 third = RetractLeft(second, 3 * kFrameSeconds * Velocity());
  EXPECT_LT(Distance(motion.Predict(second, 3 * kFrameSeconds).cam_from_world, third), 1e-12);
}

TEST(MotionModel, TurnsByTheGyroscopeAboutTheCentreThatGoesOn) {
  MotionModel motion;
  const Rigid3 second = RetractLeft(Rigid3{}, kFrameSeconds * Velocity());
  motion.Observe(Rigid3{}, EstimateAt(second), kFrameSeconds);
  CameraTurn turn;
  turn.b_from_a = ExpSo3({0.3, -0.2, 0.1});
  turn.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  const TurnedPrediction turned = motion.PredictTurned(second, kFrameSeconds, turn);
  const PosePrior usual = motion.Predict(second, kFrameSeconds);
  const Rigid3& pose = turned.prior.cam_from_world;
  EXPECT_LT(LogSo3(pose.rotation * (turn.b_from_a * second.rotation).conjugate()).norm(), 1e-12);
  EXPECT_LT((Inverse(pose).translation - Inverse(usual.cam_from_world).translation).norm(), 1e-12);
  ASSERT_TRUE(turned.covariance);
  // The rotation is known better than without, the place as well.
  const Matrix6d without = usual.information.inverse();
  for (int i = 0; i < 3; ++i) EXPECT_LT((*turned.covariance)(i, i), 0.1 * without(i, i));
  EXPECT_GT((*turned.covariance)(5, 5), 0.9 * without(5, 5));
  EXPECT_GT(turned.direction_sigma, 0);
  // After more than a second the centre counts as at rest.
  const Rigid3 late = motion.PredictTurned(second, 1.5, turn).prior.cam_from_world;
  EXPECT_LT((Inverse(late).translation - Inverse(second).translation).norm(), 1e-12);
}

TEST(MotionModel, KnowsLessTheLongerAgoTheLastFrameIs) {
  MotionModel motion;
  motion.Observe(Rigid3{}, EstimateAt(Rigid3{}), kFrameSeconds);
  const auto sigma = [&](double seconds) -> Vector6d {
    return motion.Predict(Rigid3{}, seconds).information.inverse().diagonal().cwiseSqrt();
  };
  const Vector6d soon = sigma(kFrameSeconds);
  const Vector6d later = sigma(4 * kFrameSeconds);
  for (int i = 0; i < 6; ++i) EXPECT_GT(later(i), 10 * soon(i)) << i;
  EXPECT_NEAR(soon(5), 4 * soon(0), 0.1 * soon(5));  // translations in the unit of the depth
}

TEST(MotionModel, TellsHowWellTheLastPoseIsKnown) {
  MotionModel motion;
  EXPECT_FALSE(motion.LastPoseIsKnownTo(1));
  motion.Observe(Rigid3{}, EstimateAt(Rigid3{}), kFrameSeconds);  // 0.001 rad, 0.001 m of 4 m
  EXPECT_TRUE(motion.LastPoseIsKnownTo(1.1e-3));
  EXPECT_FALSE(motion.LastPoseIsKnownTo(0.9e-3));
  motion.ChangeUnit(10);
  EXPECT_TRUE(motion.LastPoseIsKnownTo(1.1e-3));
  motion.Forget();
  EXPECT_FALSE(motion.LastPoseIsKnownTo(1));
}

TEST(MotionModel, OfAVelocityAloneHasNoInformation) {
  MotionModel motion;
  motion.Begin(Velocity());
  const PosePrior prior = motion.Predict(Rigid3{}, kFrameSeconds);
  EXPECT_LT(Distance(prior.cam_from_world, ExpSe3(kFrameSeconds * Velocity())), 1e-12);
  EXPECT_TRUE(prior.information.isZero());
  motion.Forget();
  EXPECT_FALSE(motion.IsKnown());
}

TEST(MotionModel, PredictsTheSameInAnotherUnit) {
  constexpr double kScale = 2;
  MotionModel metres, halves;
  const Rigid3 moved = ExpSe3(kFrameSeconds * Velocity());
  metres.Observe(Rigid3{}, EstimateAt(moved), kFrameSeconds);
  halves = metres;
  halves.ChangeUnit(kScale);
  const PosePrior a = metres.Predict(Rigid3{}, kFrameSeconds);
  const PosePrior b = halves.Predict(Rigid3{}, kFrameSeconds);
  EXPECT_LT((b.cam_from_world.translation - kScale * a.cam_from_world.translation).norm(), 1e-12);
  Vector6d unit = Vector6d::Ones();
  unit.tail<3>() *= kScale;
  const Matrix6d in_metres = unit.asDiagonal() * b.information * unit.asDiagonal();
  EXPECT_LT((in_metres - a.information).norm(), 1e-9 * a.information.norm());
}

}  // namespace
}  // namespace plumbline
