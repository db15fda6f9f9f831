// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/se3.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace plumbline {

namespace {

// Coefficients of I + a [w]x + b [w]x^2 forms, by series if the closed form suffers from
// cancellation.
struct Coefficients {
  double sine;    // sin(t) / t
  double cosine;  // (1 - cos(t)) / t^2
  double cubic;   // (t - sin(t)) / t^3
};

Coefficients CoefficientsOf(double t) {
  const double t2 = t * t;
  if (t < 1e-3) {
    return {1 - t2 / 6 + t2 * t2 / 120,
            0.5 - t2 / 24 + t2 * t2 / 720,
            1.0 / 6 - t2 / 120 + t2 * t2 / 5040};
  }
  return {math::Sin(t) / t, (1 - math::Cos(t)) / t2, (t - math::Sin(t)) / (t2 * t)};
}

}  // namespace

Eigen::Quaterniond ExpSo3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const double half = 0.5 * angle;
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48 : math::Sin(half) / angle;
  Eigen::Quaterniond q(math::Cos(half), scale * w.x(), scale * w.y(), scale * w.z());
  return q.normalized();
}

Eigen::Vector3d LogSo3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double w = sign * q.w();
  const double n = v.norm();
  if (n < 1e-7) return (2.0 / w) * (1 - n * n / (3 * w * w)) * v;
  return (2.0 * math::Atan2(n, w) / n) * v;
}

Eigen::Quaterniond ShortestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  // Between nearly opposite directions 1 + cosine consists of rounding errors. Half a turn about an
  // axis across `from` leaves only a small turn to be made, which is computed accurately.
  if (cosine < -1 + 1e-6) {
    const Eigen::Vector3d axis = BasisAcross(a).col(0);
    return ShortestTurn(-a, b) * Eigen::Quaterniond(0, axis.x(), axis.y(), axis.z());
  }
  const double twice_w = std::sqrt(2 * (1 + cosine));
  Eigen::Quaterniond turn;
  turn.vec() = a.cross(b) * (1 / twice_w);
  turn.w() = 0.5 * twice_w;
  return turn;
}

Eigen::Matrix3d LeftJacobianSo3(const Eigen::Vector3d& w) {
  const Coefficients c = CoefficientsOf(w.norm());
  const Eigen::Matrix3d W = Skew(w);
  return Eigen::Matrix3d::Identity() + c.cosine * W + c.cubic * W * W;
}

Eigen::Matrix3d InverseLeftJacobianSo3(const Eigen::Vector3d& w) {
  const double t = w.norm();
  const Eigen::Matrix3d W = Skew(w);
  const double t2 = t * t;
  // The half angle is used because the form with (1 + cos t) / sin t is 0 / 0 at pi.
  const double b = t < 1e-3 ? 1.0 / 12 + t2 / 720 : (1 - 0.5 * t / math::Tan(0.5 * t)) / t2;
  return Eigen::Matrix3d::Identity() - 0.5 * W + b * W * W;
}

Eigen::Matrix4d Rigid3::Matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Rigid3 ExpSe3(const Vector6d& tangent) {
  const Eigen::Vector3d w = tangent.head<3>();
  return {ExpSo3(w), LeftJacobianSo3(w) * tangent.tail<3>()};
}

Vector6d LogSe3(const Rigid3& motion) {
  const Eigen::Vector3d w = LogSo3(motion.rotation);
  Vector6d tangent;
  tangent << w, InverseLeftJacobianSo3(w) * motion.translation;
  return tangent;
}

Matrix6d Adjoint(const Rigid3& motion) {
  const Eigen::Matrix3d R = motion.rotation.toRotationMatrix();
  Matrix6d m = Matrix6d::Zero();
  m.topLeftCorner<3, 3>() = R;
  m.bottomRightCorner<3, 3>() = R;
  m.bottomLeftCorner<3, 3>() = Skew(motion.translation) * R;
  return m;
}

Rigid3 Interpolate(const Rigid3& a, const Rigid3& b, double s) {
  const Eigen::Vector3d turn = LogSo3(a.rotation.conjugate() * b.rotation);
  return {(a.rotation * ExpSo3(s * turn)).normalized(),
          (1 - s) * a.translation + s * b.translation};
}

double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return LogSo3(a.conjugate() * b).norm();
}

bool IsRotation(const Eigen::Quaterniond& quaternion) {
  return std::abs(quaternion.norm() - 1) <= kMostNormError;
}

Eigen::Quaterniond UnitRotation(const Eigen::Quaterniond& quaternion, std::string_view what) {
  constexpr double kRounding = 1e-9;
  const double norm = quaternion.norm();
  if (std::abs(norm - 1) <= kRounding) return quaternion;
  if (IsRotation(quaternion)) return quaternion.normalized();
  std::ostringstream message;
  message << what << ": expected a quaternion of norm 1, found one of norm " << norm;
  throw InputError(message.str());
}

}  // namespace plumbline
