// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/stereo_correction.h"

#include "plumbline/features/single_precision.h"

#include <cmath>
#include <cstddef>

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

namespace {

// Returns the number of single precision that solves measured = corrected +
// displacement_at(measured). The displacement changes with the place by far less than the place
// does, so that each round gains two digits or more. The rounding removes the rest, and the
// solution is exact.
template <class DisplacementAt>
double Measured(double corrected, const DisplacementAt& displacement_at) {
  constexpr int kMaxRounds = 12;
  double measured = InSinglePrecision(corrected);
  for (int round = 0; round < kMaxRounds; ++round) {
    const double next = InSinglePrecision(corrected + displacement_at(measured));
    if (next == measured) break;
    measured = next;
  }
  return measured;
}

}  // namespace

void Correct(const StereoCorrection& before,
             const StereoCorrection& correction,
             Features& features) {
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    auto& disparity = features.point_disparity[i];
    if (!disparity) continue;
    const auto right = [&](double px) {
      return Eigen::Vector2d(features.points[i].px - Eigen::Vector2d(px, 0));
    };
    const double measured =
        Measured(disparity->px, [&](double px) { return before.At(right(px)); });
    disparity->px = measured - correction.At(right(measured));
  }
  const auto correct_end = [&](Eigen::Vector2d& end) {
    end.x() = Measured(end.x(), [&](double x) { return -before.At({x, end.y()}); });
    end.x() += correction.At(end);
  };
  for (auto& right : features.line_right) {
    if (!right) continue;
    correct_end(right->segment.start);
    correct_end(right->segment.end);
  }
}

}  // namespace plumbline
