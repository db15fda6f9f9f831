// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/line_cutting/cutting_problem.h"

#include <span>

#include <Eigen/Core>

namespace plumbline {

// A line in pose estimation: the two distances of its cut points from the measured line (second
// paper, eq. 1) and the weight of their squares.
struct WeightedCut {
  CuttableLine line;
  LineCut cut;  // only lines with cut.used count
  Eigen::Matrix2d weight = Eigen::Matrix2d::Identity();
};

// Returns the motion better_from_present that minimizes the sum of r^T weight r: eq. 3 with
// Levenberg-Marquardt, starting from no motion. No robust loss: the errors of the testbed are
// normal.
Rigid3 SolvePoseFromLines(const RectifiedCamera& camera, std::span<const WeightedCut> lines);

// Returns the most likely motion together with the cut points: each point may move from its
// measured position, at the cost of its covariance (InterpolatedCovariance; the two points of a
// line count as independent), and is eliminated inside each iteration. `weight` is not used: the
// covariances and sigma_px give the weight of each residual. Without this freedom the derivatives
// are those at wrong points, and motions are underestimated: errors in the variables of a
// regression.
Rigid3 SolvePoseAndPoints(const RectifiedCamera& camera, std::span<const WeightedCut> lines);

}  // namespace plumbline
