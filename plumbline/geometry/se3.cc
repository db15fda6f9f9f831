// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/se3.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// Coefficients of I + a [w]x + b [w]x^2 forms, by series where the closed form cancels.
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

Eigen::Matrix3d LeftJacobianSo3(const Eigen::Vector3d& w) {
  const Coefficients c = CoefficientsOf(w.norm());
  const Eigen::Matrix3d W = Skew(w);
  return Eigen::Matrix3d::Identity() + c.cosine * W + c.cubic * W * W;
}

Eigen::Matrix3d InverseLeftJacobianSo3(const Eigen::Vector3d& w) {
  const double t = w.norm();
  const Eigen::Matrix3d W = Skew(w);
  const double t2 = t * t;
  // By the half angle: the form with (1 + cos t) / sin t is 0 / 0 at pi.
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

namespace {

// The block Q(w, v) of the left Jacobian of SE(3) (Barfoot, State Estimation for Robotics, 7.86).
Eigen::Matrix3d TranslationBlock(const Eigen::Vector3d& w, const Eigen::Vector3d& v) {
  const double t = w.norm();
  const double t2 = t * t;
  const double a = CoefficientsOf(t).cubic;
  const double b =
      t < 1e-2 ? 1.0 / 24 - t2 / 720 + t2 * t2 / 40320 : (t2 / 2 + math::Cos(t) - 1) / (t2 * t2);
  const double c = t < 1e-2 ? 1.0 / 120 - t2 / 2520 + t2 * t2 / 120960
                            : (t - 1.5 * math::Sin(t) + 0.5 * t * math::Cos(t)) / (t2 * t2 * t);
  const Eigen::Matrix3d W = Skew(w);
  const Eigen::Matrix3d V = Skew(v);
  const Eigen::Matrix3d WV = W * V;
  const Eigen::Matrix3d VW = V * W;
  const Eigen::Matrix3d WV_w = WV * W;
  return 0.5 * V + a * (WV + VW + WV_w) + b * (W * WV + VW * W - 3 * WV_w) +
         c * (WV_w * W + W * WV_w);
}

Matrix6d BlockLowerTriangular(const Eigen::Matrix3d& diagonal, const Eigen::Matrix3d& lower) {
  Matrix6d m = Matrix6d::Zero();
  m.topLeftCorner<3, 3>() = diagonal;
  m.bottomRightCorner<3, 3>() = diagonal;
  m.bottomLeftCorner<3, 3>() = lower;
  return m;
}

}  // namespace

Matrix6d LeftJacobianSe3(const Vector6d& tangent) {
  const Eigen::Vector3d w = tangent.head<3>();
  return BlockLowerTriangular(LeftJacobianSo3(w), TranslationBlock(w, tangent.tail<3>()));
}

Matrix6d InverseLeftJacobianSe3(const Vector6d& tangent) {
  const Eigen::Vector3d w = tangent.head<3>();
  const Eigen::Matrix3d inverse = InverseLeftJacobianSo3(w);
  return BlockLowerTriangular(inverse, -inverse * TranslationBlock(w, tangent.tail<3>()) * inverse);
}

Matrix6d Adjoint(const Rigid3& motion) {
  const Eigen::Matrix3d R = motion.rotation.toRotationMatrix();
  return BlockLowerTriangular(R, Skew(motion.translation) * R);
}

Rigid3 Interpolate(const Rigid3& a, const Rigid3& b, double s) {
  const Eigen::Vector3d turn = LogSo3(a.rotation.conjugate() * b.rotation);
  return {(a.rotation * ExpSo3(s * turn)).normalized(),
          (1 - s) * a.translation + s * b.translation};
}

double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return LogSo3(a.conjugate() * b).norm();
}

}  // namespace plumbline
