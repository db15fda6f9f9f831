// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/inertial/gyroscope.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/tracking/pose_estimation.h"

#include <optional>

namespace plumbline {

// A prediction by the turn that a gyroscope measured.
struct TurnedPrediction {
  PosePrior prior;
  // Covariance of prior's pose; nullopt if that of the last pose is not known, and prior has no
  // information.
  std::optional<Matrix6d> covariance;
  // Deviation of the direction to a point at the scene's depth, in radians; 0 without covariance.
  double direction_sigma = 0;
};

// Predicts the pose of the next frame by constant velocity, with a covariance for the expected
// changes of velocity.
class MotionModel {
 public:
  // Predicts the pose of the frame `seconds` after the last one. The covariance combines that of
  // the last pose with the accelerations of handheld cameras and cars. If the motion is unknown,
  // the prediction is the last pose without information.
  PosePrior Predict(const Rigid3& last_pose, double seconds) const;
  // Predicts by the turn since the last pose and constant velocity of the centre, for up to a
  // second; after that the centre counts as at rest.
  TurnedPrediction PredictTurned(const Rigid3& last_pose,
                                 double seconds,
                                 const CameraTurn& turn) const;

  // Updates the velocity by the last pose and that of the frame `seconds` later. Returns the
  // covariance of the latter, of its left perturbation [rotation, translation].
  const Matrix6d& Observe(const Rigid3& last_pose, const PoseEstimate& pose, double seconds);
  // Begins with a velocity alone (left tangent per second); the covariance of the last pose is then
  // unknown.
  void Begin(const Vector6d& velocity);
  void Forget();
  // Changes the scale: all lengths are multiplied by `scale`.
  void ChangeUnit(double scale);

  bool IsKnown() const { return velocity_.has_value(); }
  // Covariance of the last pose, of its left perturbation; nullopt if it is not known.
  std::optional<Matrix6d> LastCovariance() const {
    return spread_ ? std::optional(spread_->covariance) : std::nullopt;
  }
  // Returns true if the deviations of the last pose (SigmaOfPose) are known and at most `limit`.
  bool LastPoseIsKnownTo(double limit) const;

 private:
  // Covariance of the last pose, and scene depth there.
  struct Spread {
    Matrix6d covariance;
    double scene_depth = 0;
  };

  std::optional<Vector6d> velocity_;  // velocity of the camera as a left tangent, per second
  std::optional<Spread> spread_;
};

}  // namespace plumbline
