// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_manifolds.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

template <int kRows, int kCols>
using RowMajor = Eigen::Matrix<double, kRows, kCols, Eigen::RowMajor>;

// Matrix of a -> q a for quaternions as [x y z w].
Eigen::Matrix4d LeftProduct(const Eigen::Vector4d& q) {
  Eigen::Matrix4d m = q(3) * Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() += Skew(q.head<3>());
  m.topRightCorner<3, 1>() += q.head<3>();
  m.bottomLeftCorner<1, 3>() -= q.head<3>().transpose();
  return m;
}

// Matrix of a -> a q.
Eigen::Matrix4d RightProduct(const Eigen::Vector4d& q) {
  Eigen::Matrix4d m = q(3) * Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() -= Skew(q.head<3>());
  m.topRightCorner<3, 1>() += q.head<3>();
  m.bottomLeftCorner<1, 3>() -= q.head<3>().transpose();
  return m;
}

Eigen::Vector4d Conjugate(const Eigen::Vector4d& q) { return {-q(0), -q(1), -q(2), q(3)}; }

// Matrix of a -> a q for rotations multiplied from the left, of a -> q a for those from the right.
template <bool kLeft>
Eigen::Matrix4d SideProduct(const Eigen::Vector4d& q) {
  return kLeft ? RightProduct(q) : LeftProduct(q);
}

}  // namespace

void WritePose(const Rigid3& pose, double* x) {
  std::copy_n(pose.rotation.coeffs().data(), 4, x);
  std::copy_n(pose.translation.data(), 3, x + 4);
}

Rigid3 ReadPose(const double* x) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(x)).normalized(),
          Eigen::Map<const Eigen::Vector3d>(x + 4)};
}

void WriteLine(const OrthonormalLine& line, double* x) {
  std::copy_n(line.U.coeffs().data(), 4, x);
  std::copy_n(line.w.data(), 2, x + 4);
}

OrthonormalLine ReadLine(const double* x) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(x)).normalized(),
          Eigen::Map<const Eigen::Vector2d>(x + 4).normalized()};
}

bool LeftRigid3Manifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  WritePose(RetractLeft(ReadPose(x), Eigen::Map<const Vector6d>(delta)), x_plus_delta);
  return true;
}

bool LeftRigid3Manifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<7, 6>> J(jacobian);
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(x);
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(x + 4);
  J.setZero();
  J.topLeftCorner<4, 3>() = 0.5 * RightProduct(q).leftCols<3>();
  J.bottomLeftCorner<3, 3>() = -Skew(t);
  J.bottomRightCorner<3, 3>().setIdentity();
  return true;
}

bool LeftRigid3Manifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector6d> out(y_minus_x);
  out = LogSe3(ReadPose(y) * Inverse(ReadPose(x)));
  return true;
}

bool LeftRigid3Manifold::MinusJacobian(const double* x, double* jacobian) const {
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(x);
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(x + 4);
  const Eigen::Matrix<double, 3, 4> dw = 2 * RightProduct(Conjugate(q)).topRows<3>();
  Eigen::Map<RowMajor<6, 7>> J(jacobian);
  J << dw, Eigen::Matrix3d::Zero(), Skew(t) * dw, Eigen::Matrix3d::Identity();
  return true;
}

template <bool kLeft>
bool LineManifold<kLeft>::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Map<const Eigen::Vector4d> step(delta);
  const OrthonormalLine line = ReadLine(x);
  WriteLine(kLeft ? RetractLeft(line, step) : Retract(line, step), x_plus_delta);
  return true;
}

template <bool kLeft>
bool LineManifold<kLeft>::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<6, 4>> J(jacobian);
  J.setZero();
  J.template topLeftCorner<4, 3>() =
      0.5 * SideProduct<kLeft>(Eigen::Map<const Eigen::Vector4d>(x)).template leftCols<3>();
  J(4, 3) = -x[5];
  J(5, 3) = x[4];
  return true;
}

template <bool kLeft>
bool LineManifold<kLeft>::Minus(const double* y, const double* x, double* y_minus_x) const {
  const OrthonormalLine a = ReadLine(x);
  const OrthonormalLine b = ReadLine(y);
  Eigen::Map<Eigen::Vector4d> out(y_minus_x);
  out.head<3>() = LogSo3(kLeft ? b.U * a.U.conjugate() : a.U.conjugate() * b.U);
  out(3) = math::Atan2(a.w.x() * b.w.y() - a.w.y() * b.w.x(), a.w.dot(b.w));
  return true;
}

template <bool kLeft>
bool LineManifold<kLeft>::MinusJacobian(const double* x, double* jacobian) const {
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(x);
  Eigen::Map<RowMajor<4, 6>> J(jacobian);
  J.setZero();
  J.template topLeftCorner<3, 4>() = 2 * SideProduct<kLeft>(Conjugate(q)).template topRows<3>();
  J(3, 4) = -x[5];
  J(3, 5) = x[4];
  return true;
}

template class LineManifold<false>;
template class LineManifold<true>;

bool StraightLineManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  WriteLine(RetractStraight(ReadLine(x), Eigen::Map<const Eigen::Vector4d>(delta)), x_plus_delta);
  return true;
}

}  // namespace plumbline
