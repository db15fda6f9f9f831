// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"

#include <vector>

namespace plumbline {

// Which motions the poses of a graph may make: with measured depth the unit is known.
enum class PoseGraphMotion { kRigid, kSimilarity };

// A measured relative pose of two cameras.
struct PoseGraphEdge {
  int to = 0, from = 0;   // indices of poses
  Similarity3 to_from;    // measured: to_from = pose of `to` * inverse(pose of `from`)
  Matrix7d information =  // of the left perturbation [rotation, translation, log scale]; the last
      Matrix7d::Zero();   // row and column do not count for rigid motions
  bool may_be_wrong = false;  // it may join two places that are not the same
};

// Poses of cameras and what was measured between them, as plain data. A pose takes the world to the
// camera in the camera's own unit: cam_from_world of a similarity.
struct PoseGraph {
  PoseGraphMotion motion = PoseGraphMotion::kRigid;
  std::vector<Similarity3> poses;  // cam_from_world
  std::vector<bool> fixed;         // one per pose; at least one must be
  std::vector<PoseGraphEdge> edges;
};

struct PoseGraphOptions {
  int max_iterations = 20;       // of Gauss-Newton, in all
  double step_tolerance = 1e-6;  // ends when no pose moves further: radians, map units, log scale
  // An edge that may be wrong is right when its squared Mahalanobis norm is below this: by default
  // the 99.9 % quantile of chi2 with seven degrees of freedom.
  double max_chi2 = 24.3;
};

struct PoseGraphResult {
  std::vector<Similarity3> poses;
  std::vector<double> weights;  // by edge: 1; of edges that may be wrong between 0 (wrong) and 1
  std::vector<double> chi2;     // by edge: squared Mahalanobis norm of its residual, unweighted
  int iterations = 0;
  bool converged = false;  // the last step was within the tolerance
};

// The residual of an edge, Log(predicted * inverse(measured)), a left perturbation of to_from.
Vector7d PoseGraphResidual(const PoseGraphEdge& edge,
                           const Similarity3& to,
                           const Similarity3& from);

// The poses that the edges agree with best: Gauss-Newton with left perturbations, the sparse system
// solved front by front (multifrontal_cholesky.h).
//
// Edges that may be wrong have the truncated squares as their loss, c^2 = max_chi2, approached by
// graduated non-convexity (Yang, Antonante, Tzoumas and Carlone, RA-L 2020): the first solution
// takes all of them at their word, and those that then disagree most lose weight first. One that is
// firmer than all that speaks against it bends the rest instead: whether it belongs shows in the
// sum of chi2, which a right one raises by its degrees of freedom.
//
//   graph    poses are the initial ones; what no edge ties to a fixed pose stays where it is
//   returns  always a result; judge it by `converged`, the weights and chi2
//   cost     about 0.1 s an iteration for 3,000 poses with 10 neighbours each; mostly 4 or 5
PoseGraphResult SolvePoseGraph(const PoseGraph& graph, const PoseGraphOptions& options = {});

}  // namespace plumbline
