// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cutting_problem.h"

#include <array>

#include <Eigen/Core>

namespace plumbline {

// Residual of one cut point, in pixels: its distance from the measured image line (second paper,
// eq. 1), with derivatives.
struct CutResidual {
  double r = 0;
  Eigen::Vector3d gradient;  // derivative with respect to the point in the camera frame
  // Derivative with respect to the left perturbation exp([w, v]): gradient^T H_x.
  Vector6d pose_row;
  // derivative of `gradient` with respect to the ratio of the cut
  Eigen::Vector3d gradient_by_ratio;
  Vector6d pose_row_by_ratio;
};

CutResidual EvaluateCutPoint(const RectifiedCamera& camera, const CuttableLine& line, double ratio);

// Returns the covariance of the point at a ratio, (1 - a)^2 Sigma_0 + a^2 Sigma_1 (section 4.1).
Eigen::Matrix3d InterpolatedCovariance(const CuttableLine& line, double ratio);

// The two residuals of a cut line. Its information about the pose is rows^T weight rows.
struct CutResiduals {
  Eigen::Matrix<double, 2, 6> rows;
  // derivative of row k with respect to the ratio of point k
  Eigen::Matrix<double, 2, 6> rows_by_ratio;
  Eigen::Matrix2d weight;
  std::array<Eigen::Matrix2d, 2> weight_by_ratio;
};

// Computes the residuals with the weight
//   independent  diag(1 / v), v = g^T Sigma(a) g + sigma_px^2
//   printed      diag(g^T Sigma(a)^-1 g): the middle of eq. 5, see PoseInformation for the rest
//   correlated   inverse of the covariance of the two residuals, which comes from the common ends
//                of both points, and from the measured image line, whose ends have sigma_px each.
//                If both points coincide there is only one residual: each then counts half.
CutResiduals EvaluateCut(const RectifiedCamera& camera,
                         const CuttableLine& line,
                         const LineCut& cut,
                         CuttingInformation information);

}  // namespace plumbline
