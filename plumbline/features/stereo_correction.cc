// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/stereo_correction.h"

#include <cmath>

namespace plumbline {
namespace {

Eigen::Vector2d Centre(const RectifiedCamera& camera) { return {camera.cx, camera.cy}; }

double InverseUnit(const RectifiedCamera& camera) { return 2.0 / camera.width; }

Vector6d TermsAt(const Eigen::Vector2d& px, const Eigen::Vector2d& centre, double inverse_unit) {
  const Eigen::Vector2d place = (px - centre) * inverse_unit;
  const double x = place.x();
  const double y = place.y();
  Vector6d terms;
  terms << 1, x, y, x * x, x * y, y * y;
  return terms;
}

}  // namespace

StereoCorrection::StereoCorrection(const RectifiedCamera& camera, const Vector6d& coefficients)
    : centre_(Centre(camera)), inverse_unit_(InverseUnit(camera)), coefficients_(coefficients) {}

Vector6d StereoCorrection::Terms(const RectifiedCamera& camera, const Eigen::Vector2d& px) {
  return TermsAt(px, Centre(camera), InverseUnit(camera));
}

double StereoCorrection::At(const Eigen::Vector2d& px) const {
  return coefficients_.dot(TermsAt(px, centre_, inverse_unit_));
}

bool StereoCorrection::IsFinite() const {
  bool finite = true;
  VisitNumbers(*this, [&](double number) { finite = finite && std::isfinite(number); });
  return finite;
}

}  // namespace plumbline
