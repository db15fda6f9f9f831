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
constexpr double kNoEnd = std::numeric_limits<double>::infinity();
// This is far beyond any image: 89.4 degrees off the axis.
constexpr double kFarRadius = 100;

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

using Polynomial = std::array<double, 5>;

// Returns d(s f(s^2))/ds as a polynomial in u = s^2.
Polynomial SlopeOf(Polynomial f) {
  for (std::size_t i = 0; i < f.size(); ++i) f[i] *= static_cast<double>(2 * i + 1);
  return f;
}

// The radial part of a distortion: s becomes s times a quotient of polynomials in u = s^2, where s
// is r or theta.
struct RadialPart {
  Polynomial numerator = {1, 0, 0, 0, 0};
  Polynomial denominator = {1, 0, 0, 0, 0};
  bool quotient = false;

  double Factor(double u) const {
    const double factor = Evaluate(numerator, u);
    return quotient ? factor / Evaluate(denominator, u) : factor;
  }
  // d(s factor)/ds.
  double Slope(double u) const {
    const double slope = Evaluate(SlopeOf(numerator), u);
    if (!quotient) return slope;
    const double below = Evaluate(denominator, u);
    const double turn = Evaluate(SlopeOf(denominator), u) - below;
    return (slope - Evaluate(numerator, u) * turn / below) / below;
  }
  // Returns s at which s factor stops rising, at most `limit`; infinity if it does not before.
  double End(double limit) const {
    std::vector<double> turns = SignChanges(SlopeOf(numerator), limit * limit);
    if (quotient) {
      // slope * denominator - numerator * (slope of the denominator - denominator)
      std::array<double, 2 * std::tuple_size_v<Polynomial> - 1> rise{};
      for (std::size_t i = 0; i < numerator.size(); ++i) {
        for (std::size_t j = 0; j < denominator.size(); ++j) {
          const double order = 1 + 2 * static_cast<double>(i) - 2 * static_cast<double>(j);
          rise[i + j] += order * numerator[i] * denominator[j];
        }
      }
      turns = SignChanges(rise, limit * limit);
      for (const double pole : SignChanges(denominator, limit * limit)) turns.push_back(pole);
    }
    return turns.empty() ? kNoEnd : std::sqrt(*std::min_element(turns.begin(), turns.end()));
  }
  // Returns s in [0, high] that becomes `bent`: Newton steps in a bracket. nullopt if there is
  // none.
  std::optional<double> Invert(double bent, double high) const {
    double low = 0;
    const auto bent_of = [&](double s) { return s * Factor(s * s); };
    // The end may be a pole, known to rounding: just before it the bent radius is without limit.
    const double end = high;
    for (double back = 1e-14; quotient && !(bent_of(high) > bent) && back < 1e-4; back *= 10) {
      high = end * (1 - back);
    }
    if (!(bent_of(high) > bent)) return std::nullopt;
    double s = std::clamp(bent, low, high);
    for (int i = 0; i < 100 && high - low > kConverged; ++i) {
      const double error = bent_of(s) - bent;
      (error > 0 ? high : low) = s;
      if (std::abs(error) < kConverged) break;
      // Takes a Newton step if it stays in the bracket, otherwise bisects.
      s -= error / Slope(s * s);
      if (!(s > low && s < high)) s = 0.5 * (low + high);
    }
    return s;
  }
};

RadialPart RadialOf(const CameraIntrinsics& in) {
  const std::array<double, kMostCoefficients>& k = in.distortion;
  switch (in.model) {
    case DistortionModel::kRadTan:
      return {{1, k[0], k[1], k[4], 0}};
    case DistortionModel::kEquidistant:
      return {{1, k[0], k[1], k[2], k[3]}};
    case DistortionModel::kRational:
      return {{1, k[0], k[1], k[4], 0}, {1, k[5], k[6], k[7], 0}, true};
    case DistortionModel::kOmni:
      return {{1, k[1], k[2], 0, 0}};
    case DistortionModel::kNone:
    case DistortionModel::kFov:
    case DistortionModel::kDoubleSphere:
    case DistortionModel::kEucm:
      break;
  }
  return {};
}

// The tangential coefficients p1, p2.
Eigen::Vector2d TangentialOf(const CameraIntrinsics& in) {
  const std::size_t first = in.model == DistortionModel::kOmni ? 3 : 2;
  const bool any = in.model == DistortionModel::kRadTan || in.model == DistortionModel::kRational ||
                   in.model == DistortionModel::kOmni;
  return any ? Eigen::Vector2d(in.distortion[first], in.distortion[first + 1])
             : Eigen::Vector2d::Zero();
}

// True if a model does not bend what ToPlane gives.
bool EndsOnPlane(DistortionModel model) {
  return model == DistortionModel::kNone || model == DistortionModel::kEquidistant ||
         model == DistortionModel::kFov || model == DistortionModel::kDoubleSphere ||
         model == DistortionModel::kEucm;
}

// Angle off the axis at which the first step of a model ends.
double PlaneAngle(const CameraIntrinsics& in) {
  constexpr double kPi = std::numbers::pi;
  const std::array<double, kMostCoefficients>& k = in.distortion;
  // The tangent to the image plane's rays: usual w of the papers.
  const auto w = [](double alpha) {
    return alpha <= 0.5 ? alpha / (1 - alpha) : (1 - alpha) / alpha;
  };
  switch (in.model) {
    case DistortionModel::kEquidistant:
      return std::min(RadialOf(in).End(kPi), kPi);
    case DistortionModel::kDoubleSphere: {
      const double w1 = w(k[1]);
      return math::Acos(-(w1 + k[0]) / std::sqrt(2 * w1 * k[0] + k[0] * k[0] + 1));
    }
    case DistortionModel::kEucm: {
      const double w1 = w(k[0]);
      return math::Atan2(std::sqrt(std::max(0.0, 1 - w1 * w1)), -w1 * std::sqrt(k[1]));
    }
    case DistortionModel::kOmni:
      return math::Acos(k[0] <= 1 ? -k[0] : -1 / k[0]);
    case DistortionModel::kNone:
    case DistortionModel::kRadTan:
    case DistortionModel::kRational:
    case DistortionModel::kFov:
      break;
  }
  return kPi / 2;
}

// The number that divides (x, y), and its gradient.
struct Divisor {
  double value = 1;
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();
};

Divisor DivisorOf(const CameraIntrinsics& in, const Eigen::Vector3d& p) {
  const std::array<double, kMostCoefficients>& k = in.distortion;
  const double z = p.z();
  const double n = p.norm();
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  switch (in.model) {
    case DistortionModel::kOmni:
      return {z + k[0] * n, axis + k[0] * p / n};
    case DistortionModel::kDoubleSphere: {
      const double shifted = k[0] * n + z;
      const double d2 = Eigen::Vector3d(p.x(), p.y(), shifted).norm();
      const Eigen::Vector3d rise = k[0] * p / n + axis;
      const Eigen::Vector3d d2_rise = (Eigen::Vector3d(p.x(), p.y(), 0) + shifted * rise) / d2;
      return {k[1] * d2 + (1 - k[1]) * shifted, k[1] * d2_rise + (1 - k[1]) * rise};
    }
    case DistortionModel::kEucm: {
      const double d = std::sqrt(k[1] * p.head<2>().squaredNorm() + z * z);
      const Eigen::Vector3d rise = Eigen::Vector3d(k[1] * p.x(), k[1] * p.y(), z) / d;
      return {k[0] * d + (1 - k[0]) * z, k[0] * rise + (1 - k[0]) * axis};
    }
    case DistortionModel::kNone:
    case DistortionModel::kRadTan:
    case DistortionModel::kEquidistant:
    case DistortionModel::kRational:
    case DistortionModel::kFov:
      break;
  }
  return {z, axis};
}

// The radius of a point on the plane by its radius rho = |(x, y)| and z, with its derivatives, of
// the models that bend the angle.
struct AngularRadius {
  double value = 0, by_rho = 1, by_z = 0;
};

AngularRadius AngularRadiusOf(const CameraIntrinsics& in, double rho, double z) {
  if (in.model == DistortionModel::kFov) {
    const double w = in.distortion[0];
    const double slope = 2 * math::Tan(0.5 * w);
    const double squared = slope * slope * rho * rho + z * z;
    return {
        math::Atan2(slope * rho, z) / w, slope * z / (squared * w), -slope * rho / (squared * w)};
  }
  const RadialPart radial = RadialOf(in);
  const double theta = math::Atan2(rho, z);
  const double slope = radial.Slope(theta * theta) / (rho * rho + z * z);
  return {theta * radial.Factor(theta * theta), slope * z, -slope * rho};
}

void Expect(bool condition, const char* expected, double found) {
  if (condition) return;
  std::ostringstream message;
  message << "camera: expected " << expected << ", found " << found;
  throw InputError(message.str());
}

}  // namespace

std::optional<std::string> CoefficientFault(const CameraIntrinsics& in) {
  const std::array<double, kMostCoefficients>& k = in.distortion;
  const auto fault = [&](bool right, const char* expected, double found) {
    std::ostringstream text;
    text << FormOf(in.model).name << ": expected " << expected << ", found " << found;
    return right ? std::nullopt : std::optional(text.str());
  };
  const auto alpha_fault = [&](double alpha) {
    return fault(alpha >= 0 && alpha <= 1, "alpha from 0 to 1", alpha);
  };
  switch (in.model) {
    case DistortionModel::kFov:
      return fault(k[0] > 1e-6 && k[0] < 3.1415, "w between 0 and pi", k[0]);
    case DistortionModel::kDoubleSphere:
      if (auto wrong = fault(k[0] > -1 && k[0] <= 1, "xi above -1, at most 1", k[0])) return wrong;
      return alpha_fault(k[1]);
    case DistortionModel::kEucm:
      if (auto wrong = alpha_fault(k[0])) return wrong;
      return fault(k[1] > 1e-6 && k[1] < 1e6, "beta above 0", k[1]);
    case DistortionModel::kOmni:
      return fault(k[0] >= 0 && k[0] < 1e3, "xi from 0 to 1000", k[0]);
    case DistortionModel::kNone:
    case DistortionModel::kRadTan:
    case DistortionModel::kEquidistant:
    case DistortionModel::kRational:
      break;
  }
  return std::nullopt;
}

Camera::Camera(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  const CameraIntrinsics& in = intrinsics_;
  Expect(std::isfinite(in.fx) && in.fx > 0, "fx > 0", in.fx);
  Expect(std::isfinite(in.fy) && in.fy > 0, "fy > 0", in.fy);
  Expect(std::isfinite(in.cx), "a finite cx", in.cx);
  Expect(std::isfinite(in.cy), "a finite cy", in.cy);
  Expect(in.width > 0, "width > 0", in.width);
  Expect(in.height > 0, "height > 0", in.height);
  for (const double k : in.distortion) Expect(std::isfinite(k), "finite distortion", k);
  if (const auto fault = CoefficientFault(in)) throw InputError("camera: " + *fault);
  max_angle_ = PlaneAngle(in);
  min_cosine_ = max_angle_ == std::numbers::pi / 2 ? 0 : math::Cos(max_angle_);
  if (EndsOnPlane(in.model)) return;
  max_radius_ = RadialOf(in).End(kFarRadius);
  if (!std::isfinite(max_radius_)) return;
  if (const auto end = FromPlane({max_radius_, 0})) {
    max_angle_ = std::min(max_angle_, math::Atan2(end->x(), end->z()));
  }
}

bool Camera::IsIdeal() const {
  if (intrinsics_.model == DistortionModel::kNone) return true;
  const bool plane = intrinsics_.model == DistortionModel::kRadTan ||
                     intrinsics_.model == DistortionModel::kRational;
  return plane && std::ranges::all_of(intrinsics_.distortion, [](double k) { return k == 0; });
}

double Camera::CentreFocal() const {
  ProjectionJacobian J;
  Project(Eigen::Vector3d::UnitZ(), &J);
  return 0.5 * (J(0, 0) + J(1, 1));
}

std::optional<Eigen::Vector2d> Camera::Distort(const Eigen::Vector2d& ideal,
                                               Eigen::Matrix2d* jacobian) const {
  const double r2 = ideal.squaredNorm();
  const double r = std::sqrt(r2);
  if (!(r < max_radius_)) return std::nullopt;
  // distorted = scale(r^2) ideal + tangential part.
  const RadialPart radial = RadialOf(intrinsics_);
  const double scale = radial.Factor(r * r);
  Eigen::Vector2d distorted = scale * ideal;
  const Eigen::Vector2d tangential = TangentialOf(intrinsics_);
  const double p1 = tangential.x();
  const double p2 = tangential.y();
  const double x = ideal.x();
  const double y = ideal.y();
  distorted.x() += 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  distorted.y() += p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  if (jacobian != nullptr) {
    // d(r scale)/dr is the slope, so that d(scale)/dr = (slope - scale) / r.
    const double slope = radial.Slope(r * r);
    const Eigen::Vector2d axis = r < 1e-5 ? Eigen::Vector2d::Zero() : Eigen::Vector2d(ideal / r);
    *jacobian = scale * Eigen::Matrix2d::Identity() + (slope - scale) * axis * axis.transpose();
    const double mixed = 2 * (p1 * x + p2 * y);
    (*jacobian)(0, 0) += 2 * p1 * y + 6 * p2 * x;
    (*jacobian)(0, 1) += mixed;
    (*jacobian)(1, 0) += mixed;
    (*jacobian)(1, 1) += 6 * p1 * y + 2 * p2 * x;
  }
  return distorted;
}

std::optional<Eigen::Vector2d> Camera::Undistort(const Eigen::Vector2d& distorted) const {
  if (IsIdeal() || EndsOnPlane(intrinsics_.model)) return distorted;
  const double distorted_radius = distorted.norm();
  if (!std::isfinite(distorted_radius)) return std::nullopt;
  const std::optional<double> radius =
      RadialOf(intrinsics_).Invert(distorted_radius, std::min(max_radius_, kFarRadius));
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
      if (!Distort(ideal, nullptr)) return std::nullopt;
      return ideal;
    }
  }
  return std::nullopt;
}

std::optional<Eigen::Vector2d> Camera::ToPlane(const Eigen::Vector3d& point,
                                               ProjectionJacobian* jacobian) const {
  const Eigen::Vector2d xy = point.head<2>();
  const double z = point.z();
  const double n = point.norm();
  if (!(min_cosine_ == 0 ? z > 0 : z > min_cosine_ * n) || n == 0) return std::nullopt;
  const bool angular = intrinsics_.model == DistortionModel::kEquidistant ||
                       intrinsics_.model == DistortionModel::kFov;
  if (!angular) {
    const Divisor divisor = DivisorOf(intrinsics_, point);
    const Eigen::Vector2d plane = xy / divisor.value;
    if (jacobian != nullptr) {
      *jacobian = -plane * divisor.gradient.transpose() / divisor.value;
      jacobian->leftCols<2>() += Eigen::Matrix2d::Identity() / divisor.value;
    }
    return plane;
  }
  const double rho = xy.norm();
  const AngularRadius radius = AngularRadiusOf(intrinsics_, rho, z);
  if (rho == 0 && z < 0) return std::nullopt;  // a circle of pixels
  const double scale = rho == 0 ? radius.by_rho : radius.value / rho;
  if (jacobian != nullptr) {
    const Eigen::Vector2d axis = rho == 0 ? Eigen::Vector2d::Zero() : Eigen::Vector2d(xy / rho);
    jacobian->leftCols<2>() =
        scale * Eigen::Matrix2d::Identity() + (radius.by_rho - scale) * axis * axis.transpose();
    jacobian->col(2) = radius.by_z * axis;
  }
  return scale * xy;
}

std::optional<Eigen::Vector3d> Camera::FromPlane(const Eigen::Vector2d& plane) const {
  const std::array<double, kMostCoefficients>& k = intrinsics_.distortion;
  const double r2 = plane.squaredNorm();
  const double r = std::sqrt(r2);
  if (!std::isfinite(r2)) return std::nullopt;
  Eigen::Vector3d ray(plane.x(), plane.y(), 1);
  switch (intrinsics_.model) {
    case DistortionModel::kNone:
    case DistortionModel::kRadTan:
    case DistortionModel::kRational:
      return ray;
    case DistortionModel::kFov: {
      if (!(r * k[0] < std::numbers::pi / 2)) return std::nullopt;
      const double slope = 2 * math::Tan(0.5 * k[0]);
      if (r > 0) ray.head<2>() *= math::Tan(r * k[0]) / (slope * r);
      return ray;
    }
    case DistortionModel::kEquidistant: {
      const std::optional<double> theta = RadialOf(intrinsics_).Invert(r, max_angle_);
      if (!theta) return std::nullopt;
      if (r > 0) ray << plane * (math::Sin(*theta) / r), math::Cos(*theta);
      return ray;
    }
    case DistortionModel::kOmni: {
      const double root = 1 + (1 - k[0] * k[0]) * r2;
      const double length = (k[0] + std::sqrt(root)) / (1 + r2);
      ray << length * plane, length - k[0];
      break;
    }
    case DistortionModel::kDoubleSphere: {
      const double xi = k[0], alpha = k[1];
      const double mz =
          (1 - alpha * alpha * r2) / (alpha * std::sqrt(1 - (2 * alpha - 1) * r2) + 1 - alpha);
      const double length = (mz * xi + std::sqrt(mz * mz + (1 - xi * xi) * r2)) / (mz * mz + r2);
      ray << length * plane, length * mz - xi;
      break;
    }
    case DistortionModel::kEucm: {
      const double alpha = k[0], beta = k[1];
      ray.z() = (1 - beta * alpha * alpha * r2) /
                (alpha * std::sqrt(1 - (2 * alpha - 1) * beta * r2) + 1 - alpha);
      break;
    }
  }
  // Roots of negative numbers are NaN, which fails.
  return ray.z() > min_cosine_ * ray.norm() ? std::optional(ray) : std::nullopt;
}

std::optional<Eigen::Vector2d> Camera::Project(const Eigen::Vector3d& point,
                                               ProjectionJacobian* jacobian) const {
  ProjectionJacobian J_plane;
  const std::optional<Eigen::Vector2d> plane =
      ToPlane(point, jacobian != nullptr ? &J_plane : nullptr);
  if (!plane) return std::nullopt;
  Eigen::Matrix2d J_lens = Eigen::Matrix2d::Identity();
  std::optional<Eigen::Vector2d> distorted = plane;
  if (!EndsOnPlane(intrinsics_.model)) {
    distorted = Distort(*plane, jacobian != nullptr ? &J_lens : nullptr);
  }
  if (!distorted) return std::nullopt;
  const Eigen::Vector2d focal(intrinsics_.fx, intrinsics_.fy);
  if (jacobian != nullptr) *jacobian = focal.asDiagonal() * J_lens * J_plane;
  return Eigen::Vector2d(focal.cwiseProduct(*distorted) +
                         Eigen::Vector2d(intrinsics_.cx, intrinsics_.cy));
}

std::optional<Eigen::Vector3d> Camera::Ray(const Eigen::Vector2d& px) const {
  const std::optional<Eigen::Vector2d> plane = Undistort(
      {(px.x() - intrinsics_.cx) / intrinsics_.fx, (px.y() - intrinsics_.cy) / intrinsics_.fy});
  return plane ? FromPlane(*plane) : std::nullopt;
}

std::optional<Eigen::Vector3d> Camera::Unproject(const Eigen::Vector2d& px) const {
  const std::optional<Eigen::Vector3d> ray = Ray(px);
  if (!ray || !(ray->z() > 1e-9 * ray->norm())) return std::nullopt;
  return Eigen::Vector3d(ray->x() / ray->z(), ray->y() / ray->z(), 1.0);
}

}  // namespace plumbline
