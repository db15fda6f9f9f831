// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"

#include <Eigen/Core>

namespace plumbline {

// Radial distortion of the lens that the calibration has left. A place px of the image, at d from
// the principal point in halves of the image's width, belongs at px - border_px |d|^2 d. border_px
// is thus the correction at the side of the image, in pixels.
class LensCorrection {
 public:
  // The largest border_px that is plausible, in widths of the image.
  static constexpr double kLargest = 0.03;

  LensCorrection() = default;  // no distortion is left
  LensCorrection(const RectifiedCamera& camera, double border_px);

  double border_px() const { return border_px_; }
  // Returns the displacement of what the image shows at a place: px is to be corrected to
  // px - ShiftAt(px).
  Eigen::Vector2d ShiftAt(const Eigen::Vector2d& px) const;
  Eigen::Vector2d At(const Eigen::Vector2d& px) const { return px - ShiftAt(px); }
  // Returns by how much the correction shrinks the surroundings of a place, in the mean over all
  // directions.
  double ScaleAt(const Eigen::Vector2d& px) const;

  bool operator==(const LensCorrection&) const = default;
  // Whether it is a number, and not so large that it folds the image over.
  bool IsPlausible() const;

 private:
  Eigen::Vector2d FromCentre(const Eigen::Vector2d& px) const {
    return (px - centre_) * inverse_unit_;
  }

  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double inverse_unit_ = 1;
  double border_px_ = 0;
};

}  // namespace plumbline
