// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/optimization/problem.h"

namespace plumbline {

// Bundle adjustment of poses, points and lines: Levenberg-Marquardt, with landmarks eliminated by
// the Schur complement with fixed-size blocks (poses 6, points 3, lines 4).
//
// Minimizes the whitened residuals of PointMeasurement and LineMeasurement (Lee and Hwang, ICCV
// 2019, eq. 13 for lines, Jacobians eq. 16-21) under the Huber loss. Between rounds, observations
// are kept or rejected by chi2 at 95 %; a rejected one may come back. Each landmark has its own
// damping on top of the global one. If a step raises a landmark's cost, that landmark alone is
// moved by more strongly damped steps of its own, so that degenerate lines do not slow down the
// others. A parallel line adds the two components of its unit direction across the axis, over
// sigma, under the loss of lines; it is kept or rejected from round to round like an observation.
// Poses marked fixed and landmarks without observations do not move. The caller must fix the gauge;
// parameters without observations are fixed by the damping.
//
//   problem   poses cam_from_world, landmarks in the world, measurements in pixels; indices must be
//             in range (BugError otherwise), rotations of norm 1 (UnitRotation; InputError
//             otherwise)
//   stop      called in every iteration, and while the equations of many poses are solved
//   returns   finite numbers whenever the input is finite
//   cost      per iteration O(sum over landmarks of their poses squared), and the time of
//             SchurSolver::Solve
BaResult SolveLocalBa(const BaProblem& problem,
                      const LocalBaOptions& options = {},
                      const StopCheck& stop = {});

// A function with the interface of SolveLocalBa.
using BaSolver = BaResult (*)(const BaProblem& problem,
                              const LocalBaOptions& options,
                              const StopCheck& stop);

}  // namespace plumbline
