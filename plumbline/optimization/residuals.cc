// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/residuals.h"

#include "plumbline/base/error.h"

namespace plumbline {

PointTerm MakePointTerm(const PointMeasurement& measurement) {
  PLUMBLINE_CHECK(measurement.sigma_px > 0, "sigma_px of a point must be positive");
  PointTerm term{
      .u = measurement.px.x(), .v = measurement.px.y(), .weight = 1 / measurement.sigma_px};
  if (measurement.disparity) {
    PLUMBLINE_CHECK(measurement.disparity->sigma_px > 0,
                    "sigma_px of a disparity must be positive");
    term.disparity = measurement.disparity->px;
    term.disparity_weight = 1 / measurement.disparity->sigma_px;
  }
  return term;
}

LineTerm MakeLineTerm(const RectifiedCamera& camera, const LineMeasurement& measurement) {
  const Eigen::Matrix2d& S = measurement.covariance;
  const double variance = S(1, 1) - S(1, 0) * S(1, 0) / S(0, 0);
  PLUMBLINE_CHECK(S(0, 0) > 0 && variance > 0, "covariance of a line must be positive definite");
  // S = L L^T with L = [l00 0; l10 l11]; the whitening matrix is L^-1.
  const double l00 = std::sqrt(S(0, 0));
  const double l11 = std::sqrt(variance);
  return {.start = measurement.segment.start,
          .end = measurement.segment.end,
          .w00 = 1 / l00,
          .w10 = -S(1, 0) / (l00 * l00 * l11),
          .w11 = 1 / l11,
          .shift = measurement.in_right_camera ? -camera.baseline : 0.0};
}

std::optional<PointResidual> EvaluatePoint(const RectifiedCamera& camera,
                                           const Rigid3& cam_from_world,
                                           const Eigen::Vector3d& point_in_world,
                                           const PointMeasurement& measurement) {
  const Eigen::Vector3d p = cam_from_world * point_in_world;
  PointLinearization lin;
  if (!LinearizePoint(camera, MakePointTerm(measurement), p, lin)) return std::nullopt;
  const Eigen::Matrix3d J_cam = PointJacobian(lin);
  PointResidual out;
  out.rows = measurement.disparity ? 3 : 2;
  out.r = lin.r;
  out.J_pose << -J_cam * Skew(p), J_cam;
  out.J_point = J_cam * cam_from_world.rotation.toRotationMatrix();
  return out;
}

std::optional<LineResidual> EvaluateLine(const RectifiedCamera& camera,
                                         const Rigid3& cam_from_world,
                                         const OrthonormalLine& line_in_world,
                                         const LineMeasurement& measurement) {
  const LineTerm term = MakeLineTerm(camera, measurement);
  const Vector6d h = line_in_world.Homogeneous();
  const Eigen::Matrix3d R = cam_from_world.rotation.toRotationMatrix();
  const Eigen::Vector3d direction = R * h.tail<3>();
  // The right camera sees points displaced by e, hence its translation is t + e.
  const Eigen::Vector3d t = cam_from_world.translation + Eigen::Vector3d(term.shift, 0, 0);
  const Eigen::Vector3d moment = R * h.head<3>() + t.cross(direction);
  LineLinearization lin;
  if (!LinearizeLine(camera, term, moment, lin)) return std::nullopt;
  LineResidual out;
  out.r = lin.r;
  out.J_pose << LinePoseRow(lin.h0, moment, direction, term.shift).transpose(),
      LinePoseRow(lin.h1, moment, direction, term.shift).transpose();
  Eigen::Matrix<double, 2, 6> J_homogeneous;  // eq. 18: d moment / d (m, d) = [R, [t]x R]
  J_homogeneous << (R.transpose() * lin.h0).transpose(),
      (R.transpose() * lin.h0.cross(t)).transpose(), (R.transpose() * lin.h1).transpose(),
      (R.transpose() * lin.h1.cross(t)).transpose();
  out.J_line = J_homogeneous * HomogeneousJacobian(line_in_world);
  return out;
}

}  // namespace plumbline
