// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/feature_correction.h"

#include "plumbline/features/single_precision.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace plumbline {

LensCorrection::LensCorrection(const RectifiedCamera& camera, double border_px)
    : centre_(camera.cx, camera.cy), inverse_unit_(2.0 / camera.width), border_px_(border_px) {}

Eigen::Vector2d LensCorrection::ShiftAt(const Eigen::Vector2d& px) const {
  const Eigen::Vector2d d = FromCentre(px);
  return border_px_ * d.squaredNorm() * d;
}

Segment2 LensCorrection::At(const Segment2& segment) const {
  // Along a straight line the displacement across it is a polynomial of second degree. The least
  // squares line through it meets it at these two places, of the half length from the middle.
  static const double kMeets = std::sqrt(1.0 / 3);
  const Eigen::Vector2d middle = segment.Midpoint();
  const Eigen::Vector2d half = 0.5 * (segment.end - segment.start);
  const Eigen::Vector2d normal = Eigen::Vector2d(-half.y(), half.x()).normalized();
  const double before = normal.dot(ShiftAt(middle - kMeets * half));
  const double after = normal.dot(ShiftAt(middle + kMeets * half));
  const double mean = 0.5 * (before + after);
  const double slope = 0.5 * (after - before) / kMeets;
  const auto moved = [&](const Eigen::Vector2d& end, double across) {
    const Eigen::Vector2d shift = ShiftAt(end);
    return Eigen::Vector2d(end - shift + (normal.dot(shift) - across) * normal);
  };
  return {moved(segment.start, mean - slope), moved(segment.end, mean + slope)};
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

// Most rounds in which a measured number is recovered. The correction changes with the place by far
// less than the place does, so that most corrections need four rounds, and all that are as large as
// they may be fewer than these. Rounding to single precision makes the solution exact.
constexpr int kMaxRounds = 64;

// Returns the number or the place of single precision that solves measured = corrected +
// displacement_at(measured).
template <class Value, class DisplacementAt>
Value Measured(const Value& corrected, const DisplacementAt& displacement_at) {
  Value measured = InSinglePrecision(corrected);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Value next = InSinglePrecision(Value(corrected + displacement_at(measured)));
    if (next == measured) break;
    measured = next;
  }
  return measured;
}

void Correct(const StereoCorrection& before,
             const StereoCorrection& correction,
             Features& features) {
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    Disparity* const disparity = features.point_disparity.Find(i);
    if (disparity == nullptr) continue;
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
  for (MeasuredSegment& right : features.line_right.values()) {
    correct_end(right.segment.start);
    correct_end(right.segment.end);
  }
}

Eigen::Vector4d EndsOf(const Segment2& segment) {
  Eigen::Vector4d ends;
  ends << segment.start, segment.end;
  return ends;
}

Segment2 SegmentWith(const Eigen::Vector4d& ends) { return {ends.head<2>(), ends.tail<2>()}; }

// Deviations shrink with the surroundings of their place.
void Correct(const LensCorrection& before, const LensCorrection& correction, Features& features) {
  const auto measured_at = [&](const Eigen::Vector2d& px) {
    return Measured(px, [&](const Eigen::Vector2d& place) { return before.ShiftAt(place); });
  };
  const auto rescale = [&](const Eigen::Vector2d& measured, double& sigma_px) {
    sigma_px =
        InSinglePrecision(sigma_px / before.ScaleAt(measured)) * correction.ScaleAt(measured);
  };
  for (PointFeature& point : features.points) {
    const Eigen::Vector2d measured = measured_at(point.px);
    rescale(measured, point.sigma_px);
    point.px = correction.At(measured);
  }
  for (LineFeature& line : features.lines) {
    const Eigen::Vector4d measured =
        Measured(EndsOf(line.segment), [&](const Eigen::Vector4d& ends) {
          return Eigen::Vector4d(ends - EndsOf(before.At(SegmentWith(ends))));
        });
    const Segment2 segment = SegmentWith(measured);
    rescale(segment.Midpoint(), line.sigma_px);
    line.segment = correction.At(segment);
  }
}

}  // namespace

bool FeatureCorrection::IsPlausible() const { return stereo.IsFinite() && lens.IsPlausible(); }

void Correct(const FeatureCorrection& before,
             const FeatureCorrection& correction,
             Features& features) {
  // Disparities are corrected at their measured positions, between the two steps of the lens.
  if (!(before.lens == LensCorrection())) Correct(before.lens, {}, features);
  if (!(before.stereo == correction.stereo)) Correct(before.stereo, correction.stereo, features);
  if (!(correction.lens == LensCorrection())) Correct({}, correction.lens, features);
}

}  // namespace plumbline
