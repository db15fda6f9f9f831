// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_only.h"

#include "plumbline/optimization/pose_solver.h"

namespace plumbline {

PoseOnlyResult SolvePose(const PoseProblem& problem, const PoseOnlyOptions& options) {
  return PoseSolver<PoseLine>(problem, options).Solve(problem.cam_from_world);
}

}  // namespace plumbline
