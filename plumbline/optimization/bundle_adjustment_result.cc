// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/bundle_adjustment_result.h"

#include <cstddef>
#include <limits>

namespace plumbline {

BaResult InitialState(const BaProblem& problem) {
  BaResult state;
  for (const auto& pose : problem.poses) state.poses.push_back(pose.cam_from_world);
  state.points = problem.points;
  state.lines = problem.lines;
  state.line_ends = problem.line_ends;
  state.point_inliers.assign(problem.point_observations.size(), true);
  state.line_inliers.assign(problem.line_observations.size(), true);
  return state;
}

BaResult NotFinite(const BaProblem& problem) {
  BaResult result = InitialState(problem);
  result.point_inliers.assign(problem.point_observations.size(), false);
  result.line_inliers.assign(problem.line_observations.size(), false);
  const double infinite = std::numeric_limits<double>::infinity();
  result.point_chi2.assign(problem.point_observations.size(), infinite);
  result.line_chi2.assign(problem.line_observations.size(), infinite);
  result.termination = BaTermination::kNotFinite;
  return result;
}

void TakePosesAndPoints(const BaResult& solved, BaProblem& problem) {
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    problem.poses[i].cam_from_world = solved.poses[i];
  }
  problem.points = solved.points;
}

}  // namespace plumbline
