// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/optimization/local_ba_result.h"
#include "plumbline/optimization/problem.h"

namespace plumbline {

// Bundle adjustment of poses, points and lines: Levenberg-Marquardt, landmarks eliminated by the
// Schur complement with fixed-size blocks (poses 6, points 3, lines 4).
//
// Whitened residuals of residuals.h (eq. 13 for lines, Jacobians eq. 16-21) under the Huber loss.
// Between rounds, observations are kept or rejected by chi2 at 95 % (a rejected one may come back).
// Each landmark has its own damping on top of the global one: where a landmark's step raises its
// cost, that landmark alone stands still, so that degenerate lines do not hold up the others.
// A parallel line adds the two components of its unit direction across the axis, over sigma, under
// the loss of lines; from round to round it counts or not as observations do.
// Poses marked fixed and landmarks without observations do not move. The gauge is up to the caller;
// what no observation fixes is held by the damping.
//
//   problem   indices must be in range (BugError otherwise)
//   stop      asked in every iteration, and while the equations of many poses are solved
//   returns   finite numbers whenever the input is finite
//   cost      per iteration O(sum over landmarks of their poses squared + FactorEnvelope of the
//   free ones)
BaResult SolveLocalBa(const BaProblem& problem,
                      const LocalBaOptions& options = {},
                      const StopCheck& stop = {});

// SolveLocalBa, or another function that does what it says.
using BaSolver = BaResult (*)(const BaProblem& problem,
                              const LocalBaOptions& options,
                              const StopCheck& stop);

}  // namespace plumbline
