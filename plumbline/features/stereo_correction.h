// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// Displacement of the right image of a pair along its rows relative to the calibration: a smooth
// error of the rectification, which varies over the image and does not average out. It is a
// quadratic polynomial over the right image, in pixels:
//
//   c(x, y) = k0 + k1 x + k2 y + k3 x^2 + k4 x y + k5 y^2
//
// with x, y from the principal point in halves of the image's width. A measured disparity d is
// corrected to d - c. For RGB-D the right image is virtual, and c is an error of the depths.
class StereoCorrection {
 public:
  StereoCorrection() = default;  // no displacement
  StereoCorrection(const RectifiedCamera& camera, const Vector6d& coefficients);

  // Returns the monomials of the polynomial at a pixel of the right image.
  static Vector6d Terms(const RectifiedCamera& camera, const Eigen::Vector2d& px);

  double At(const Eigen::Vector2d& px) const;
  const Vector6d& coefficients() const { return coefficients_; }
  bool operator==(const StereoCorrection&) const = default;
  bool IsFinite() const;

  // Calls visit for each coefficient of `correction`, const or not.
  template <class Correction, class Visitor>
  static void VisitNumbers(Correction& correction, const Visitor& visit) {
    visit(correction.centre_.x());
    visit(correction.centre_.y());
    visit(correction.inverse_unit_);
    for (Eigen::Index i = 0; i < correction.coefficients_.size(); ++i) {
      visit(correction.coefficients_(i));
    }
  }

 private:
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double inverse_unit_ = 1;
  Vector6d coefficients_ = Vector6d::Zero();
};

}  // namespace plumbline
