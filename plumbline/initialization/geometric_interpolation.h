// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// Poses of an intermediate frame relative to the reference and to the current frame, with
// translations in a common scale. The joint covariance is that of their left perturbations
// [rotation, translation], that relative to the reference first.
struct InterpolationPoses {
  Rigid3 between_from_reference;
  Rigid3 current_from_reference;
  Eigen::Matrix<double, 12, 12> covariance = Eigen::Matrix<double, 12, 12>::Zero();
};

// A position in the intermediate frame, in ideal image coordinates.
struct InterpolatedPoint {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  // Angle between the two epipolar lines, radians in [0, pi/2].
  double line_angle = 0;
};

// Geometric interpolation (first paper, section 2.2): finds the position, in an intermediate frame,
// of a feature matched between the reference and the current frame, as the intersection of its two
// epipolar lines there.
//
// Differs from the paper in two ways. The pose from the current to the intermediate frame is
// chained from poses with their true ratio of translations, (R, t) by (R, t), and its essential
// matrix is formed once: chained unit translations put the point 15 px off in the median, a product
// of essential matrices 200 px. The covariance of the position follows from that of both poses and
// both pixels; the angle between the lines, the criterion of the paper (5 degrees), does not
// determine it.
class GeometricInterpolation {
 public:
  // Prepares for all features of these frames: forms the essential matrices and their covariances
  // once.
  explicit GeometricInterpolation(const InterpolationPoses& poses);

  //   reference, current  ideal image coordinates and the standard deviation of each
  //   returns             nullopt if the lines are parallel or meet at infinity
  std::optional<InterpolatedPoint> Interpolate(const Eigen::Vector2d& reference,
                                               double reference_sigma,
                                               const Eigen::Vector2d& current,
                                               double current_sigma) const;

 private:
  // One of the two relative poses, target_from_source.
  struct Epipolar {
    Eigen::Matrix3d R;
    Eigen::Vector3d t;
    Eigen::Matrix3d E;
  };
  // Returns the part of the variance of x . E x_source, for x in the intermediate frame, that is
  // due to the pixel of the source.
  static double PixelVariance(const Epipolar& pair, const Eigen::Vector3d& x, double sigma);
  // Returns the derivative of x . E x_source by the left perturbation of the pose.
  static Vector6d PoseRow(const Epipolar& pair,
                          const Eigen::Vector3d& source,
                          const Eigen::Vector3d& line,
                          const Eigen::Vector3d& x);

  Epipolar from_reference_;
  Epipolar from_current_;
  // Covariances of the left perturbations of between_from_reference and between_from_current.
  Matrix6d reference_covariance_;
  Matrix6d current_covariance_;
  Matrix6d cross_covariance_;
};

}  // namespace plumbline
