// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// A tangent of SE(3), [rotation(3), translation(3)].
using Vector6d = Eigen::Matrix<double, 6, 1>;
// A covariance, information or Jacobian of tangents of SE(3).
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// [v]x, the matrix with [v]x w = v x w.
inline Eigen::Matrix3d Skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Rotation by the angle |w| (radians) about the axis w. Accurate for all |w|, also near 0.
Eigen::Quaterniond ExpSo3(const Eigen::Vector3d& w);

// Inverse of ExpSo3 with |result| <= pi.
Eigen::Vector3d LogSo3(const Eigen::Quaterniond& q);

// Returns the rotation by the least angle that turns the direction of `from` into that of `to`. If
// the directions are opposite to 0.1 degrees, the axis of the half turn is arbitrary.
Eigen::Quaterniond ShortestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// Left Jacobian of SO(3): Exp(w + dw) = Exp(LeftJacobianSo3(w) dw) Exp(w) to first order.
Eigen::Matrix3d LeftJacobianSo3(const Eigen::Vector3d& w);
// The inverse of LeftJacobianSo3(w).
Eigen::Matrix3d InverseLeftJacobianSo3(const Eigen::Vector3d& w);

// A rigid motion b_from_a: p_b = rotation * p_a + translation. The seven numbers are contiguous in
// memory: [qx qy qz qw tx ty tz], starting at rotation.coeffs().data().
//
// Perturbations are from the left with the rotation first: exp([w, v]) * T
// (docs/adr/0002-frames-units-tangents.md).
struct Rigid3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  // Returns a point of frame a in frame b.
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  // Returns b_from_x, the product of b_from_a and a_from_x.
  Rigid3 operator*(const Rigid3& a_from_x) const {
    return {(rotation * a_from_x.rotation).normalized(),
            rotation * a_from_x.translation + translation};
  }
  // Returns the motion as a matrix of homogeneous coordinates.
  Eigen::Matrix4d Matrix() const;
};

// Returns a_from_b for b_from_a.
inline Rigid3 Inverse(const Rigid3& b_from_a) {
  const Eigen::Quaterniond inverse = b_from_a.rotation.conjugate();
  return {inverse, -(inverse * b_from_a.translation)};
}

// Exponential map of se(3); tangent = [rotation(3), translation(3)].
Rigid3 ExpSe3(const Vector6d& tangent);
// Inverse of ExpSe3, with a rotation part of at most pi.
Vector6d LogSe3(const Rigid3& motion);

// Returns exp(tangent) * motion, the update of all pose optimization here.
inline Rigid3 RetractLeft(const Rigid3& motion, const Vector6d& tangent) {
  return ExpSe3(tangent) * motion;
}

// Adjoint: T exp(x) T^-1 = exp(Adjoint(T) x).
Matrix6d Adjoint(const Rigid3& motion);

// Returns the motion a fraction s in [0, 1] of the way from a to b: slerp of the rotation, straight
// line of the translation.
Rigid3 Interpolate(const Rigid3& a, const Rigid3& b, double s);

// Angle of the rotation between two orientations, radians in [0, pi].
double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

// Rule for rotations given by callers and files: a quaternion is a rotation if its norm is 1 to
// within kMostNormError. It is then normalized, unless its norm is 1 up to rounding (1e-9): then it
// stays the same to the last bit. Any other quaternion is refused.
constexpr double kMostNormError = 0.01;

// Returns true if the norm is 1 to within kMostNormError; false for NaN.
bool IsRotation(const Eigen::Quaterniond& quaternion);

// Returns the rotation by the rule above. Throws InputError "WHAT: expected a quaternion of norm 1,
// found one of norm 2".
Eigen::Quaterniond UnitRotation(const Eigen::Quaterniond& quaternion, std::string_view what);

// Returns two orthonormal directions, as columns, perpendicular to a unit vector t. A change of the
// direction t is written in them: t + basis d, normalized.
inline Eigen::Matrix<double, 3, 2> BasisAcross(const Eigen::Vector3d& direction) {
  Eigen::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = direction.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  basis.col(1) = direction.cross(basis.col(0)).normalized();
  return basis;
}

}  // namespace plumbline
