// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_optimization.h"

#include "plumbline/geometry/unit_rotation.h"
#include "plumbline/optimization/pose_solver.h"

namespace plumbline {

PoseOnlyResult SolvePose(const PoseProblem& problem, const PoseOnlyOptions& options) {
  const Rigid3& given = problem.cam_from_world;
  const Rigid3 initial{UnitRotation(given.rotation, "cam_from_world"), given.translation};
  return PoseSolver<PoseLine>(problem, options).Solve(initial);
}

}  // namespace plumbline
