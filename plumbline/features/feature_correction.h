// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// Radial lens distortion left by the calibration. A pixel px of the image, at d from the principal
// point in halves of the image's width, is corrected to px - border_px |d|^2 d. border_px is thus
// the correction at the left and right border of the image, in pixels.
class LensCorrection {
 public:
  // Largest plausible border_px, in widths of the image.
  static constexpr double kLargest = 0.03;

  LensCorrection() = default;  // no correction
  LensCorrection(const RectifiedCamera& camera, double border_px);

  double border_px() const { return border_px_; }
  // Returns the displacement at a pixel: px is corrected to px - ShiftAt(px).
  Eigen::Vector2d ShiftAt(const Eigen::Vector2d& px) const;
  Eigen::Vector2d At(const Eigen::Vector2d& px) const { return px - ShiftAt(px); }
  // Returns the segment that a line fit finds in the corrected image where it finds `segment` in
  // the measured one. There a straight edge is a curve, and the ends of the line through it lie
  // beside the curve. Each end moves along the line as its own pixel does, and across the line by
  // the least squares line through the displacements along the segment.
  Segment2 At(const Segment2& segment) const;
  // Returns the factor by which the correction shrinks the surroundings of a pixel, in the mean
  // over all directions.
  double ScaleAt(const Eigen::Vector2d& px) const;

  bool operator==(const LensCorrection&) const = default;
  // Returns true if it is finite and small enough not to fold the image over.
  bool IsPlausible() const;

 private:
  Eigen::Vector2d FromCentre(const Eigen::Vector2d& px) const {
    return (px - centre_) * inverse_unit_;
  }

  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double inverse_unit_ = 1;
  double border_px_ = 0;
};

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

// Evidence of all keyframes so far about the errors of a stereo pair: normal equations of the
// coefficients of a StereoCorrection. It depends on the rig, not on a map, and evidence of
// different keyframes can be summed.
struct StereoEvidence {
  Matrix6d information = Matrix6d::Zero();
  Vector6d weighted = Vector6d::Zero();
  // Second moments of the terms over all evidence, unscaled.
  Matrix6d moments = Matrix6d::Zero();
};

// Correction of features learned during a run, beyond the calibration: the displacement between the
// images of a pair, and the lens distortion of a single camera.
struct FeatureCorrection {
  StereoCorrection stereo = {};
  LensCorrection lens = {};

  bool operator==(const FeatureCorrection&) const = default;
  bool IsPlausible() const;
};

// Replaces the correction `before` of features by another one. The measured numbers, which have
// single precision, are recovered exactly (if the correction changes by less than half a pixel from
// pixel to pixel) and corrected anew. The result does not depend on earlier corrections, to the
// last bit.
void Correct(const FeatureCorrection& before,
             const FeatureCorrection& correction,
             Features& features);

}  // namespace plumbline
