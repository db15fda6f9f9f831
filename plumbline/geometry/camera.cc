// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/camera.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/LU>

namespace plumbline {
namespace {

constexpr int kMaxNewtonSteps = 20;
constexpr double kConverged = 1e-13;

// Returns the sum of coefficients[i] x^i.
double Evaluate(std::span<const double> coefficients, double x) {
  double value = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;) value = value * x + coefficients[i];
  return value;
}

double Bisect(std::span<const double> polynomial, double low, double high) {
  const bool low_positive = Evaluate(polynomial, low) > 0;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    ((Evaluate(polynomial, middle) > 0) == low_positive ? low : high) = middle;
  }
  return low;
}

// Returns the sign changes of a polynomial in [0, limit], ascending. Between two roots of the
// derivative the polynomial is monotonic and has at most one.
std::vector<double> SignChanges(std::span<const double> polynomial, double limit) {
  if (polynomial.size() < 2) return {};
  std::vector<double> derivative;
  for (std::size_t i = 1; i < polynomial.size(); ++i) {
    derivative.push_back(static_cast<double>(i) * polynomial[i]);
  }
  std::vector<double> knots = SignChanges(derivative, limit);
  knots.push_back(limit);
  std::vector<double> roots;
  double low = 0;
  for (const double high : knots) {
    if ((Evaluate(polynomial, low) > 0) != (Evaluate(polynomial, high) > 0)) {
      roots.push_back(Bisect(polynomial, low, high));
    }
    low = high;
  }
  return roots;
}

// Returns the coefficients in u = s^2 of the radial factor 1 + c1 s^2 + c2 s^4 ..., with s = r or
// theta.
std::array<double, 5> RadialFactor(const CameraIntrinsics& in) {
  const std::array<double, 5>& k = in.distortion;
  switch (in.model) {
    case DistortionModel::kNone:
      break;
    case DistortionModel::kRadTan:
      return {1, k[0], k[1], k[4], 0};
    case DistortionModel::kEquidistant:
      return {1, k[0], k[1], k[2], k[3]};
  }
  return {1, 0, 0, 0, 0};
}

// Returns d(s factor(s^2))/ds as a polynomial in u = s^2.
std::array<double, 5> RadialSlope(const CameraIntrinsics& in) {
  std::array<double, 5> slope = RadialFactor(in);
  for (std::size_t i = 0; i < slope.size(); ++i) slope[i] *= static_cast<double>(2 * i + 1);
  return slope;
}

double MaxRadius(const CameraIntrinsics& in) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool equidistant = in.model == DistortionModel::kEquidistant;
  // This is far beyond any image: 89.4 degrees off the axis.
  constexpr double kFarRadius = 100;
  constexpr double kRightAngle = std::numbers::pi / 2;
  const double limit = equidistant ? kRightAngle * kRightAngle : kFarRadius * kFarRadius;
  const std::vector<double> turns = SignChanges(RadialSlope(in), limit);
  if (turns.empty()) return kInfinity;
  const double s = std::sqrt(turns.front());
  return equidistant ? math::Tan(s) : s;
}

void Expect(bool condition, const char* expected, double found) {
  if (condition) return;
  std::ostringstream message;
  message << "camera: expected " << expected << ", found " << found;
  throw InputError(message.str());
}

}  // namespace

Camera::Camera(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  const CameraIntrinsics& in = intrinsics_;
  Expect(std::isfinite(in.fx) && in.fx > 0, "fx > 0", in.fx);
  Expect(std::isfinite(in.fy) && in.fy > 0, "fy > 0", in.fy);
  Expect(std::isfinite(in.cx), "a finite cx", in.cx);
  Expect(std::isfinite(in.cy), "a finite cy", in.cy);
  Expect(in.width > 0, "width > 0", in.width);
  Expect(in.height > 0, "height > 0", in.height);
  for (const double k : in.distortion) Expect(std::isfinite(k), "finite distortion", k);
  max_radius_ = MaxRadius(in);
}

bool Camera::IsIdeal() const {
  if (intrinsics_.model == DistortionModel::kNone) return true;
  return intrinsics_.model == DistortionModel::kRadTan &&
         std::ranges::all_of(intrinsics_.distortion, [](double k) { return k == 0; });
}

std::optional<Eigen::Vector2d> Camera::Distort(const Eigen::Vector2d& ideal,
                                               Eigen::Matrix2d* jacobian) const {
  const double r2 = ideal.squaredNorm();
  const double r = std::sqrt(r2);
  if (!(r < max_radius_)) return std::nullopt;
  const bool equidistant = intrinsics_.model == DistortionModel::kEquidistant;
  // distorted = scale(r^2) ideal + tangential part; slope = d(scale)/d(r^2).
  const double s = equidistant ? math::Atan(r) : r;
  const double factor = Evaluate(RadialFactor(intrinsics_), s * s);
  const double ds_dr = equidistant ? 1 / (1 + r2) : 1;
  // Near the axis atan(r)/r = 1 - r^2/3.
  const bool near_axis = r < 1e-5;
  const double s_over_r = !equidistant ? 1 : (near_axis ? 1 - r2 / 3 : s / r);
  const double scale = factor * s_over_r;
  Eigen::Vector2d distorted = scale * ideal;
  const bool tangential = intrinsics_.model == DistortionModel::kRadTan;
  const double p1 = tangential ? intrinsics_.distortion[2] : 0;
  const double p2 = tangential ? intrinsics_.distortion[3] : 0;
  const double x = ideal.x();
  const double y = ideal.y();
  distorted.x() += 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  distorted.y() += p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  if (jacobian != nullptr) {
    // d(s factor)/dr = RadialSlope ds/dr, so d(scale)/dr = (that - scale) / r.
    const double radial = Evaluate(RadialSlope(intrinsics_), s * s) * ds_dr;
    const Eigen::Vector2d axis = near_axis ? Eigen::Vector2d::Zero() : Eigen::Vector2d(ideal / r);
    *jacobian = scale * Eigen::Matrix2d::Identity() + (radial - scale) * axis * axis.transpose();
    const double mixed = 2 * (p1 * x + p2 * y);
    (*jacobian)(0, 0) += 2 * p1 * y + 6 * p2 * x;
    (*jacobian)(0, 1) += mixed;
    (*jacobian)(1, 0) += mixed;
    (*jacobian)(1, 1) += 6 * p1 * y + 2 * p2 * x;
  }
  return distorted;
}

std::optional<double> Camera::UndistortRadius(double distorted_radius) const {
  const bool equidistant = intrinsics_.model == DistortionModel::kEquidistant;
  const std::array<double, 5> factor = RadialFactor(intrinsics_);
  const auto distorted_of = [&](double s) { return s * Evaluate(factor, s * s); };
  double low = 0;
  double high =
      equidistant ? std::min(math::Atan(max_radius_), 1.57) : std::min(max_radius_, 100.0);
  if (!(distorted_of(high) > distorted_radius)) return std::nullopt;
  double s = std::clamp(distorted_radius, low, high);
  for (int i = 0; i < 100 && high - low > kConverged; ++i) {
    const double error = distorted_of(s) - distorted_radius;
    (error > 0 ? high : low) = s;
    if (std::abs(error) < kConverged) break;
    // Takes a Newton step if it stays in the bracket, otherwise bisects.
    s -= error / Evaluate(RadialSlope(intrinsics_), s * s);
    if (!(s > low && s < high)) s = 0.5 * (low + high);
  }
  return equidistant ? math::Tan(s) : s;
}

std::optional<Eigen::Vector2d> Camera::Undistort(const Eigen::Vector2d& distorted) const {
  if (IsIdeal()) return distorted;
  const double distorted_radius = distorted.norm();
  if (!std::isfinite(distorted_radius)) return std::nullopt;
  const std::optional<double> radius = UndistortRadius(distorted_radius);
  if (!radius) return std::nullopt;
  Eigen::Vector2d ideal = distorted;
  if (distorted_radius > 0) ideal *= *radius / distorted_radius;
  // The tangential part is small: the radial solution is a good start.
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    Eigen::Matrix2d J;
    const std::optional<Eigen::Vector2d> value = Distort(ideal, &J);
    if (!value || !(std::abs(J.determinant()) > 1e-12)) return std::nullopt;
    const Eigen::Vector2d step = J.inverse() * (*value - distorted);
    ideal -= step;
    if (step.norm() < kConverged * (1 + ideal.norm())) {
      if (!Distort(ideal)) return std::nullopt;
      return ideal;
    }
  }
  return std::nullopt;
}

std::optional<Eigen::Vector2d> Camera::Project(const Eigen::Vector3d& point,
                                               ProjectionJacobian* jacobian) const {
  const double z = point.z();
  if (!(z > 0)) return std::nullopt;
  const Eigen::Vector2d ideal(point.x() / z, point.y() / z);
  Eigen::Matrix2d J_lens;
  const std::optional<Eigen::Vector2d> distorted =
      Distort(ideal, jacobian != nullptr ? &J_lens : nullptr);
  if (!distorted) return std::nullopt;
  const Eigen::Vector2d focal(intrinsics_.fx, intrinsics_.fy);
  if (jacobian != nullptr) {
    ProjectionJacobian J_ideal;
    J_ideal << 1, 0, -ideal.x(), 0, 1, -ideal.y();
    *jacobian = focal.asDiagonal() * J_lens * J_ideal / z;
  }
  return Eigen::Vector2d(focal.cwiseProduct(*distorted) +
                         Eigen::Vector2d(intrinsics_.cx, intrinsics_.cy));
}

std::optional<Eigen::Vector3d> Camera::Unproject(const Eigen::Vector2d& px) const {
  const std::optional<Eigen::Vector2d> ideal = Undistort(
      {(px.x() - intrinsics_.cx) / intrinsics_.fx, (px.y() - intrinsics_.cy) / intrinsics_.fy});
  if (!ideal) return std::nullopt;
  return Eigen::Vector3d(ideal->x(), ideal->y(), 1.0);
}

}  // namespace plumbline
