// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/tracking/pose_estimation.h"

#include <optional>

namespace plumbline {

// The motion of the camera between the frames: constant velocity, with what it may change by.
class MotionModel {
 public:
  // Where the next frame is, `seconds` after the last one: its pose with a covariance, that of the
  // last pose and of a velocity that changes as hands and cars change it. The last pose and no
  // information where the motion is not known.
  PosePrior Predict(const Rigid3& last_pose, double seconds) const;

  // Takes in the motion from the last pose to that of the frame `seconds` later.
  void Observe(const Rigid3& last_pose, const PoseEstimate& pose, double seconds);
  // Begins from a velocity [left tangent per second] alone, of a last pose that counts as unknown.
  void Begin(const Vector6d& velocity);
  void Forget();
  // Goes over into a unit in which lengths are `scale` times what they were.
  void ChangeUnit(double scale);

  bool IsKnown() const { return velocity_.has_value(); }

  // All that it keeps from frame to frame (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.velocity_, self.spread_);
  }

 private:
  // How well the last pose is known.
  struct Spread {
    Matrix6d covariance;
    double scene_depth = 0;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.covariance, self.scene_depth);
    }
  };

  std::optional<Vector6d> velocity_;  // left tangent of the camera's motion, per second
  std::optional<Spread> spread_;
};

}  // namespace plumbline
