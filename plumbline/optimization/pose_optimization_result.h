// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/geometry/se3.h"

#include <array>
#include <type_traits>
#include <vector>

namespace plumbline {

// Settings of SolvePose.
struct PoseOnlyOptions {
  // Rounds of solving, each followed by classifying all matches anew.
  int rounds = 4;
  // Number of first rounds with the Huber loss; the others use plain squares.
  int robust_rounds = 2;
  int max_iterations = 10;  // iterations in a round
  // a round ends if the expected decrease of the cost by a step is less than this
  double decrement_tolerance = 1e-4;
};

template <class Visitor>
void VisitFields(Visitor&& visit, PoseOnlyOptions& o) {
  visit("rounds", o.rounds, "rounds of solving and classifying the matches", Range{1, 20});
  visit("robust_rounds", o.robust_rounds, "first rounds with the Huber loss", Range{0, 20});
  visit("max_iterations", o.max_iterations, "iterations per round", Range{1, 1000});
  visit("decrement_tolerance",
        o.decrement_tolerance,
        "decrease of the cost a step must promise [sigma^2]",
        Range{0, 1});
}

// The result of SolvePose, in the order of the problem.
struct PoseOnlyResult {
  Rigid3 cam_from_world;
  // J^T W J of the inliers and the prior at the solution, for the left perturbation [rotation,
  // translation].
  Matrix6d information = Matrix6d::Zero();
  std::vector<bool> point_inliers;  // one per PoseProblem::points
  std::vector<bool> line_inliers;   // one per PoseProblem::lines; equal within a group
  int inlier_points = 0;
  int inlier_line_groups = 0;
  double cost = 0;     // half the sum of squared whitened residuals of inliers and prior
  int iterations = 0;  // sum over all rounds
  // True if the last round met a tolerance, and inliers and prior determine all six degrees of
  // freedom. If false, the pose is the best one found; it is finite if the input is.
  bool converged = false;
};

}  // namespace plumbline
