// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/motion_model.h"

#include "plumbline/optimization/pose_uncertainty.h"

#include <cmath>

namespace plumbline {
namespace {

// Standard deviations of the acceleration that the prediction allows for, as measured of hands and
// cars: rotation [rad/s^2] and translation [scene depths/s^2].
constexpr double kMotionSigma = 5;

}  // namespace

PosePrior MotionModel::Predict(const Rigid3& last_pose, double seconds) const {
  PosePrior prior{velocity_ ? RetractLeft(last_pose, seconds * *velocity_) : last_pose};
  if (!spread_) return prior;
  Vector6d sigma = Vector6d::Constant(kMotionSigma * seconds * seconds);
  sigma.tail<3>() *= spread_->scene_depth;
  Matrix6d covariance = spread_->covariance;
  covariance.diagonal() += sigma.cwiseAbs2();
  prior.information = covariance.inverse();
  return prior;
}

TurnedPrediction MotionModel::PredictTurned(const Rigid3& last_pose,
                                            double seconds,
                                            const CameraTurn& turn) const {
  constexpr double kLongest = 1;  // seconds that a velocity is believed
  const Vector6d step =
      velocity_ && seconds <= kLongest ? Vector6d(seconds * *velocity_) : Vector6d::Zero();
  const Eigen::Vector3d centre = Inverse(ExpSe3(step)).translation;
  const Rigid3 motion{turn.b_from_a, -(turn.b_from_a * centre)};
  TurnedPrediction prediction{{motion * last_pose}, std::nullopt};
  if (!spread_) return prediction;
  const Matrix6d carried = Adjoint(motion);
  Matrix6d covariance = carried * spread_->covariance * carried.transpose();
  covariance.topLeftCorner<3, 3>() += turn.covariance;
  const double moved = kMotionSigma * seconds * seconds * spread_->scene_depth;
  covariance.diagonal().tail<3>().array() += moved * moved;
  prediction.prior.information = covariance.inverse();
  prediction.covariance = covariance;
  const double depth = spread_->scene_depth;
  prediction.direction_sigma =
      std::sqrt(covariance.diagonal().head<2>().mean() +
                covariance.diagonal().segment<2>(3).mean() / (depth * depth));
  return prediction;
}

const Matrix6d& MotionModel::Observe(const Rigid3& last_pose,
                                     const PoseEstimate& pose,
                                     double seconds) {
  velocity_ = LogSe3(pose.cam_from_world * Inverse(last_pose)) / seconds;
  spread_ = Spread{pose.information.inverse(), pose.scene_depth};
  return spread_->covariance;
}

bool MotionModel::LastPoseIsKnownTo(double limit) const {
  return spread_ && SigmaOfPose(spread_->covariance.inverse(), spread_->scene_depth).AtMost(limit);
}

void MotionModel::Begin(const Vector6d& velocity) {
  velocity_ = velocity;
  spread_.reset();
}

void MotionModel::Forget() {
  velocity_.reset();
  spread_.reset();
}

void MotionModel::ChangeUnit(double scale) {
  if (velocity_) velocity_->tail<3>() *= scale;
  if (!spread_) return;
  spread_->covariance.bottomRows<3>() *= scale;
  spread_->covariance.rightCols<3>() *= scale;
  spread_->scene_depth *= scale;
}

}  // namespace plumbline
