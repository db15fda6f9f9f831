// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/line_cutting/cutting_problem.h"

#include <span>

#include <Eigen/Core>

namespace plumbline {

// A line as it enters the pose: the two distances of its cut points from the measured line (second
// paper, eq. 1) and the weight of their squares.
struct WeightedCut {
  CuttableLine line;
  LineCut cut;  // only lines with cut.used count
  Eigen::Matrix2d weight = Eigen::Matrix2d::Identity();
};

// The motion better_from_present that minimizes the sum of r^T weight r: eq. 3 with
// Levenberg-Marquardt from no motion. No robust loss: the errors of the testbed are normal.
Rigid3 SolvePoseFromLines(const RectifiedCamera& camera, std::span<const WeightedCut> lines);

// The motion and the cut points that are together most likely: each point may move from where it
// was measured, at the price of its covariance (InterpolatedCovariance; the two points of a line
// taken as independent), and is eliminated inside each iteration. `weight` is not used: the
// covariances and sigma_px say how much each residual counts. Without this freedom the derivatives
// are those at wrong points, and motions come out too small: errors in the variables of a
// regression.
Rigid3 SolvePoseAndPoints(const RectifiedCamera& camera, std::span<const WeightedCut> lines);

}  // namespace plumbline
