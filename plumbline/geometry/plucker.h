// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// An infinite 3D line in Plücker coordinates: |direction| = 1, moment = X x direction for every
// point X on the line. (Lee and Hwang, ICCV 2019, print d x X in eq. 6, which contradicts their
// eq. 9, 24 and 30; see docs/methods/plucker-lines.md.) The moment is normal to the plane through
// the line and the origin; its length is the distance of the line from the origin.
struct PluckerLine {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();

  // Point of the line nearest to the origin.
  Eigen::Vector3d Foot() const { return direction.cross(moment); }
  // Parameter of the point of the line nearest to `point`: Foot() + parameter * direction.
  double ParameterOf(const Eigen::Vector3d& point) const { return direction.dot(point); }
  // The point of the line with this parameter.
  Eigen::Vector3d PointAt(double parameter) const { return Foot() + parameter * direction; }
  // Distance of a point from the infinite line, in the unit of the points.
  double DistanceTo(const Eigen::Vector3d& point) const {
    return (point.cross(direction) - moment).norm();
  }
};

// Line through two points, directed from a to b. Undefined for a == b.
PluckerLine LineThroughPoints(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// Line in which two planes (n, d), n.X + d = 0, meet (eq. 24). nullopt when the sine of the angle
// between the normals is below 1e-9.
std::optional<PluckerLine> LineFromPlanes(const Eigen::Vector4d& plane1,
                                          const Eigen::Vector4d& plane2);

// The line in another frame (eq. 9).
PluckerLine Transform(const Rigid3& b_from_a, const PluckerLine& line_in_a);

// The 4-parameter orthonormal form (eq. 10-11, divisor corrected to sqrt(|m|^2 + |d|^2)):
// U = [m/|m|, d/|d|, m x d / |m x d|] as a rotation, w = (|m|, |d|) / sqrt(|m|^2 + |d|^2).
struct OrthonormalLine {
  Eigen::Quaterniond U = Eigen::Quaterniond::Identity();
  Eigen::Vector2d w = Eigen::Vector2d::UnitY();

  // Returns m = w.x u1 and d = w.y u2, homogeneous with |m|^2 + |d|^2 = 1: the numbers to which
  // dm/ddelta and dd/ddelta refer.
  Eigen::Matrix<double, 6, 1> Homogeneous() const;
};

// The orthonormal form of a line. A line through the origin (m = 0) gets an arbitrary but
// repeatable u1 normal to d.
OrthonormalLine ToOrthonormal(const PluckerLine& line);
// The line of an orthonormal form, with a direction of length 1.
PluckerLine ToPlucker(const OrthonormalLine& line);

// U <- U Exp(delta.head<3>()), w turned by delta(3) (section 3.1).
OrthonormalLine Retract(const OrthonormalLine& line, const Eigen::Vector4d& delta);

// U <- Exp(delta.head<3>()) U, w turned by delta(3): a turn about the axes of the frame instead of
// those of the line, as PPL-SLAM has it (reference [20] of Lee and Hwang).
OrthonormalLine RetractLeft(const OrthonormalLine& line, const Eigen::Vector4d& delta);

// Equals Retract() to first order in delta; for optimization: (m, d) moves straight along its
// derivative, then to the nearest pair with m . d = 0. The moment of the line in any camera, and
// with it the projected line, is linear in (m, d). A long Gauss-Newton step therefore ends where
// intended, while turning U and w deviates along an arc (docs/methods/plucker-lines.md).
OrthonormalLine RetractStraight(const OrthonormalLine& line, const Eigen::Vector4d& delta);

// d(m, d)/d(delta) at delta = 0 of the homogeneous 6-vector (eq. 19 with w21 in place of w12).
Eigen::Matrix<double, 6, 4> HomogeneousJacobian(const OrthonormalLine& line);

// d(m, d)/d(delta) at delta = 0 for RetractLeft(): [ -[w1 u1]x , -w2 u1 ; -[w2 u2]x , w1 u2 ].
Eigen::Matrix<double, 6, 4> LeftHomogeneousJacobian(const OrthonormalLine& line);

}  // namespace plumbline
