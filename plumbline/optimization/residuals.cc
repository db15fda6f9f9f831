// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/residuals.h"

#include "plumbline/base/error.h"

#include <Eigen/Cholesky>

namespace plumbline {

PreparedLine::PreparedLine(const OrthonormalLine& line)
    : homogeneous(line.Homogeneous()), J_orthonormal(HomogeneousJacobian(line)) {}

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
  PLUMBLINE_CHECK(IsPositiveDefinite(S), "covariance of a line must be positive definite");
  const double variance = S(1, 1) - S(1, 0) * S(1, 0) / S(0, 0);
  // S = L L^T with L = [l00 0; l10 l11]; the whitening matrix is L^-1.
  const double l00 = std::sqrt(S(0, 0));
  const double l11 = std::sqrt(variance);
  return {.start = measurement.segment.start,
          .end = measurement.segment.end,
          .w00 = 1 / l00,
          .w10 = -S(1, 0) / (l00 * l00 * l11),
          .w11 = 1 / l11,
          .shift = camera.ShiftInto(measurement.camera)};
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

namespace {

// A line in the frame of the camera that measured it.
struct MeasuredLine {
  Eigen::Matrix3d R;          // rotation of the left camera
  Eigen::Vector3d direction;  // in the left camera's frame
  // Translation of the camera that measured. The right camera sees points displaced by e, so that
  // its translation is t + e.
  Eigen::Vector3d t;
  Eigen::Vector3d moment;

  MeasuredLine(const Rigid3& cam_from_world, const Vector6d& h, double shift)
      : R(cam_from_world.rotation.toRotationMatrix()),
        direction(R * h.tail<3>()),
        t(cam_from_world.translation + Eigen::Vector3d(shift, 0, 0)),
        moment(R * h.head<3>() + t.cross(direction)) {}
};

}  // namespace

std::optional<LineResidual> EvaluateLine(const RectifiedCamera& camera,
                                         const Rigid3& cam_from_world,
                                         const OrthonormalLine& line_in_world,
                                         const LineMeasurement& measurement) {
  return EvaluateLine(camera, cam_from_world, PreparedLine(line_in_world), measurement);
}

std::optional<LineResidual> EvaluateLine(const RectifiedCamera& camera,
                                         const Rigid3& cam_from_world,
                                         const PreparedLine& line_in_world,
                                         const LineMeasurement& measurement) {
  const LineTerm term = MakeLineTerm(camera, measurement);
  const MeasuredLine line(cam_from_world, line_in_world.homogeneous, term.shift);
  LineLinearization lin;
  if (!LinearizeLine(camera, term, line.moment, lin)) return std::nullopt;
  LineResidual out;
  out.r = lin.r;
  out.J_pose << LinePoseRow(lin.h0, line.moment, line.direction, term.shift).transpose(),
      LinePoseRow(lin.h1, line.moment, line.direction, term.shift).transpose();
  const Eigen::Matrix3d& R = line.R;
  Eigen::Matrix<double, 2, 6> J_homogeneous;  // eq. 18: d moment / d (m, d) = [R, [t]x R]
  J_homogeneous << (R.transpose() * lin.h0).transpose(),
      (R.transpose() * lin.h0.cross(line.t)).transpose(), (R.transpose() * lin.h1).transpose(),
      (R.transpose() * lin.h1.cross(line.t)).transpose();
  out.J_line = J_homogeneous * line_in_world.J_orthonormal;
  return out;
}

std::optional<Eigen::Vector2d> LineDistances(const RectifiedCamera& camera,
                                             const Rigid3& cam_from_world,
                                             const PreparedLine& line_in_world,
                                             const LineMeasurement& measurement) {
  const LineTerm term = MakeLineTerm(camera, measurement);
  const MeasuredLine line(cam_from_world, line_in_world.homogeneous, term.shift);
  LineLinearization lin;
  if (!LinearizeLine(camera, term, line.moment, lin)) return std::nullopt;
  return lin.r;
}

std::optional<UncertainPointTerm> MakeUncertainPointTerm(const RectifiedCamera& camera,
                                                         const Rigid3& cam_from_world,
                                                         const Eigen::Vector3d& point_in_world,
                                                         const Eigen::Matrix3d& point_covariance,
                                                         const PointMeasurement& measurement) {
  if (point_covariance.isZero(0)) return std::nullopt;
  UncertainPointTerm out{MakePointTerm(measurement), Eigen::Matrix3d::Identity()};
  const bool with_disparity = out.term.disparity_weight > 0;
  out.term.weight = 1;
  out.term.disparity_weight = with_disparity ? 1 : 0;
  PointLinearization lin;
  if (!LinearizePoint(camera, out.term, cam_from_world * point_in_world, lin)) return std::nullopt;
  const Eigen::Matrix3d J = PointJacobian(lin) * cam_from_world.rotation.toRotationMatrix();
  // The row of the disparity is zero without disparity.
  Eigen::Matrix3d S = J * point_covariance * J.transpose();
  S.diagonal().head<2>().array() += measurement.sigma_px * measurement.sigma_px;
  S(2, 2) += with_disparity ? measurement.disparity->sigma_px * measurement.disparity->sigma_px : 1;
  const Eigen::LLT<Eigen::Matrix3d> factor(S);
  if (factor.info() != Eigen::Success) return std::nullopt;
  out.whitening = factor.matrixL().solve(Eigen::Matrix3d::Identity());
  if (!out.whitening.allFinite()) return std::nullopt;
  return out;
}

std::optional<PointResidual> EvaluateMatch(const RectifiedCamera& camera,
                                           const Rigid3& cam_from_world,
                                           const PoseProblem::PointMatch& match) {
  const auto uncertain = MakeUncertainPointTerm(
      camera, cam_from_world, match.point_in_world, match.point_covariance, match.measurement);
  if (!uncertain && !match.point_covariance.isZero(0)) return std::nullopt;
  PointMeasurement unit = match.measurement;
  if (uncertain) {
    unit.sigma_px = 1;
    if (unit.disparity) unit.disparity->sigma_px = 1;
  }
  auto residual = EvaluatePoint(camera, cam_from_world, match.point_in_world, unit);
  if (!residual || !uncertain) return residual;
  residual->r = uncertain->whitening * residual->r;
  residual->J_pose = uncertain->whitening * residual->J_pose;
  residual->J_point = uncertain->whitening * residual->J_point;
  return residual;
}

}  // namespace plumbline
