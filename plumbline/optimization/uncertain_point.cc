// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/uncertain_point.h"

#include <Eigen/Cholesky>

namespace plumbline {

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
