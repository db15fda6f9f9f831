// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/geometric_interpolation.h"

#include "plumbline/base/elementary.h"
#include "plumbline/geometry/epipolar.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

GeometricInterpolation::GeometricInterpolation(const InterpolationPoses& poses) {
  const auto epipolar = [](const Rigid3& pose) {
    return Epipolar{pose.rotation.toRotationMatrix(), pose.translation, EssentialMatrix(pose)};
  };
  const Rigid3& between = poses.between_from_reference;
  const Rigid3 between_from_current = between * Inverse(poses.current_from_reference);
  from_reference_ = epipolar(between);
  from_current_ = epipolar(between_from_current);
  // T_b exp(x_b) and T_c exp(x_c) from the left: T_bc moves by x_b - Ad(T_bc) x_c.
  const Matrix6d A = -Adjoint(between_from_current);
  const Matrix6d bb = poses.covariance.topLeftCorner<6, 6>();
  const Matrix6d bc = poses.covariance.topRightCorner<6, 6>();
  const Matrix6d cc = poses.covariance.bottomRightCorner<6, 6>();
  reference_covariance_ = bb;
  cross_covariance_ = bb + bc * A.transpose();
  current_covariance_ = bb + bc * A.transpose() + A * bc.transpose() + A * cc * A.transpose();
}

double GeometricInterpolation::PixelVariance(const Epipolar& pair,
                                             const Eigen::Vector3d& x,
                                             double sigma) {
  const Eigen::Vector2d slope = (pair.E.transpose() * x).head<2>();
  return sigma * sigma * slope.squaredNorm();
}

// Returns the derivative of x . (t x y), with y = R source. A shift v changes it by x . (v x y), a
// turn w of both t and y by x . (w x (t x y)).
Vector6d GeometricInterpolation::PoseRow(const Epipolar& pair,
                                         const Eigen::Vector3d& source,
                                         const Eigen::Vector3d& line,
                                         const Eigen::Vector3d& x) {
  Vector6d row;
  row << line.cross(x), (pair.R * source).cross(x);
  return row;
}

std::optional<InterpolatedPoint> GeometricInterpolation::Interpolate(
    const Eigen::Vector2d& reference,
    double reference_sigma,
    const Eigen::Vector2d& current,
    double current_sigma) const {
  const Eigen::Vector3d x0 = reference.homogeneous();
  const Eigen::Vector3d xc = current.homogeneous();
  const Eigen::Vector3d l0 = from_reference_.E * x0;
  const Eigen::Vector3d lc = from_current_.E * xc;
  const Eigen::Vector3d meet = l0.cross(lc);
  const double lengths = l0.head<2>().norm() * lc.head<2>().norm();
  // The second test also applies if one of the poses is at rest and has no epipolar lines.
  if (!(std::abs(meet.z()) > 1e-9 * lengths) || !(lengths > 0)) return std::nullopt;
  const Eigen::Vector3d x = meet / meet.z();
  const Vector6d row0 = PoseRow(from_reference_, x0, l0, x);
  const Vector6d rowc = PoseRow(from_current_, xc, lc, x);
  Eigen::Matrix2d variance;  // variance of the two epipolar errors
  variance(0, 0) =
      row0.dot(reference_covariance_ * row0) + PixelVariance(from_reference_, x, reference_sigma);
  variance(1, 1) =
      rowc.dot(current_covariance_ * rowc) + PixelVariance(from_current_, x, current_sigma);
  variance(0, 1) = variance(1, 0) = row0.dot(cross_covariance_ * rowc);
  // The place follows from the condition that both errors stay zero.
  Eigen::Matrix2d lines;
  lines << l0.head<2>().transpose(), lc.head<2>().transpose();
  const Eigen::Matrix2d inverse = lines.inverse();
  return InterpolatedPoint{x.head<2>(),
                           inverse * variance * inverse.transpose(),
                           math::Asin(std::min(1.0, std::abs(meet.z()) / lengths))};
}

}  // namespace plumbline
