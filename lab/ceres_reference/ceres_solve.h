// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/ceres_reference/ceres_derivatives.h"
#include "lab/line_rivals/rival_ba.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"

#include <vector>

namespace plumbline {

struct CeresBaOptions {
  HuberThresholds huber;  // infinite: no loss function
  CeresDerivatives derivatives = CeresDerivatives::kAnalytic;
  RivalLines lines;
  int max_iterations = 50;
  double function_tolerance = 1e-6;
};

struct CeresBaResult {
  std::vector<Rigid3> poses;
  std::vector<Eigen::Vector3d> points;
  std::vector<OrthonormalLine> lines;
  double initial_cost = 0;
  double final_cost = 0;
  int iterations = 0;
};

// All observations of a problem in one solve. As fast as possible: DENSE_SCHUR on one thread with
// landmarks eliminated first by an explicit ordering, measurements prepared once, analytic
// derivatives in fixed sizes directly in the tangent (TangentManifold), one loss function and one
// manifold shared by all blocks, Ceres' safety checks off. Projected ends of lines have automatic
// derivatives only: BugError with analytic ones.
CeresBaResult SolveWithCeres(const BaProblem& problem, const CeresBaOptions& options);

struct CeresPoseOptions {
  HuberThresholds huber;  // of the robust rounds
  int rounds = 4;         // of solving and classifying all matches by chi2 at 95 %
  int robust_rounds = 2;  // the first of them, the others with squares
  int max_iterations = 10;
  double function_tolerance = 1e-5;
};

struct CeresPoseResult {
  Rigid3 cam_from_world;
  int inlier_points = 0;
  int inlier_line_groups = 0;
  double final_cost = 0;  // of the last round
  int iterations = 0;
};

// The camera's pose in the rounds of SolvePose(), without its start from afar: dense normal
// equations on one thread; the problem is set up once, outliers are removed and reinserted.
CeresPoseResult SolvePoseWithCeres(const PoseProblem& problem, const CeresPoseOptions& options);

}  // namespace plumbline
