// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/plucker.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

PluckerLine LineThroughPoints(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d direction = (b - a).normalized();
  // The moment of the midpoint is accurate for both ends.
  return {(0.5 * (a + b)).cross(direction), direction};
}

std::optional<PluckerLine> LineFromPlanes(const Eigen::Vector4d& plane1,
                                          const Eigen::Vector4d& plane2) {
  const Eigen::Vector3d n1 = plane1.head<3>();
  const Eigen::Vector3d n2 = plane2.head<3>();
  const Eigen::Vector3d direction = n1.cross(n2);
  const double norm = direction.norm();
  if (!(norm > 1e-9 * n1.norm() * n2.norm())) return std::nullopt;
  // X x (n1 x n2) = n1 (X.n2) - n2 (X.n1) with X.n = -d on both planes.
  const Eigen::Vector3d moment = plane1(3) * n2 - plane2(3) * n1;
  return PluckerLine{moment / norm, direction / norm};
}

PluckerLine Transform(const Rigid3& b_from_a, const PluckerLine& line_in_a) {
  const Eigen::Vector3d direction = b_from_a.rotation * line_in_a.direction;
  return {b_from_a.rotation * line_in_a.moment + b_from_a.translation.cross(direction), direction};
}

Eigen::Matrix<double, 6, 1> OrthonormalLine::Homogeneous() const {
  Eigen::Matrix<double, 6, 1> h;
  h << w.x() * (U * Eigen::Vector3d::UnitX()), w.y() * (U * Eigen::Vector3d::UnitY());
  return h;
}

OrthonormalLine ToOrthonormal(const PluckerLine& line) {
  const double m = line.moment.norm();
  const double d = line.direction.norm();
  const Eigen::Vector3d u2 = line.direction / d;
  Eigen::Vector3d u1 = line.moment - u2 * u2.dot(line.moment);
  if (u1.norm() < 1e-12 * d) u1 = u2.unitOrthogonal();
  u1.normalize();
  Eigen::Matrix3d U;
  U << u1, u2, u1.cross(u2);
  return {Eigen::Quaterniond(U).normalized(), Eigen::Vector2d(m, d) / math::Hypot(m, d)};
}

PluckerLine ToPlucker(const OrthonormalLine& line) {
  return {(line.w.x() / line.w.y()) * (line.U * Eigen::Vector3d::UnitX()),
          line.U * Eigen::Vector3d::UnitY()};
}

OrthonormalLine Retract(const OrthonormalLine& line, const Eigen::Vector4d& delta) {
  const double c = math::Cos(delta(3));
  const double s = math::Sin(delta(3));
  return {(line.U * ExpSo3(delta.head<3>())).normalized(),
          {c * line.w.x() - s * line.w.y(), s * line.w.x() + c * line.w.y()}};
}

OrthonormalLine RetractLeft(const OrthonormalLine& line, const Eigen::Vector4d& delta) {
  const double c = math::Cos(delta(3));
  const double s = math::Sin(delta(3));
  return {(ExpSo3(delta.head<3>()) * line.U).normalized(),
          {c * line.w.x() - s * line.w.y(), s * line.w.x() + c * line.w.y()}};
}

OrthonormalLine RetractStraight(const OrthonormalLine& line, const Eigen::Vector4d& delta) {
  constexpr double kTiny = 1e-12;  // of |(m, d)|, which is 1 at the start
  const Eigen::Matrix<double, 6, 1> h = line.Homogeneous() + HomogeneousJacobian(line) * delta;
  const Eigen::Vector3d m = h.head<3>();
  const Eigen::Vector3d d = h.tail<3>();
  // The nearest pair is (m - s d, d - s m): s is the smaller root of s^2 c - s |h|^2 + c = 0.
  const double c = m.dot(d);
  const double n = h.squaredNorm();
  const double s = 2 * c / (n + std::sqrt(std::max(0.0, n * n - 4 * c * c)));
  const Eigen::Vector3d direction = d - s * m;
  if (!(direction.norm() > kTiny)) return Retract(line, delta);  // the line is at infinity
  return ToOrthonormal({m - s * d, direction});
}

Eigen::Matrix<double, 6, 4> HomogeneousJacobian(const OrthonormalLine& line) {
  const Eigen::Matrix3d U = line.U.toRotationMatrix();
  const double w1 = line.w.x();
  const double w2 = line.w.y();
  Eigen::Matrix<double, 6, 4> J = Eigen::Matrix<double, 6, 4>::Zero();
  J.block<3, 1>(0, 1) = -w1 * U.col(2);
  J.block<3, 1>(0, 2) = w1 * U.col(1);
  J.block<3, 1>(0, 3) = -w2 * U.col(0);
  J.block<3, 1>(3, 0) = w2 * U.col(2);
  J.block<3, 1>(3, 2) = -w2 * U.col(0);
  J.block<3, 1>(3, 3) = w1 * U.col(1);
  return J;
}

Eigen::Matrix<double, 6, 4> LeftHomogeneousJacobian(const OrthonormalLine& line) {
  const Eigen::Vector3d u1 = line.U * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d u2 = line.U * Eigen::Vector3d::UnitY();
  const double w1 = line.w.x();
  const double w2 = line.w.y();
  Eigen::Matrix<double, 6, 4> J;
  J << -w1 * Skew(u1), -w2 * u1, -w2 * Skew(u2), w1 * u2;
  return J;
}

}  // namespace plumbline
