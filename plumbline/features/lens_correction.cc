// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/lens_correction.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

LensCorrection::LensCorrection(const RectifiedCamera& camera, double border_px)
    : centre_(camera.cx, camera.cy), inverse_unit_(2.0 / camera.width), border_px_(border_px) {}

Eigen::Vector2d LensCorrection::ShiftAt(const Eigen::Vector2d& px) const {
  const Eigen::Vector2d d = FromCentre(px);
  return border_px_ * d.squaredNorm() * d;
}

double LensCorrection::ScaleAt(const Eigen::Vector2d& px) const {
  const double part = border_px_ * inverse_unit_ * FromCentre(px).squaredNorm();
  // The first factor is the scale along the circle around the principal point, the second along the
  // radius. A large correction folds the corners of a narrow image over; there the scale has no
  // meaning, and must only be a number.
  constexpr double kLeast = 0.01;
  return std::sqrt(std::max((1 - part) * (1 - 3 * part), kLeast));
}

bool LensCorrection::IsPlausible() const {
  return centre_.allFinite() && std::isfinite(inverse_unit_) && std::isfinite(border_px_) &&
         std::abs(border_px_) * inverse_unit_ <= 2 * kLargest;
}

}  // namespace plumbline
