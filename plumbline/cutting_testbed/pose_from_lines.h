// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/cutting/cut_lines.h"
#include "plumbline/geometry/se3.h"

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

}  // namespace plumbline
