// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/problem.h"

namespace plumbline {

// Parametrization of a line in bundle adjustment.
enum class LineParametrization {
  kPlucker,  // orthonormal form of the Plücker coordinates, 4 parameters
  // Orthonormal form turned about the axes of the frame: U <- Exp(theta) U, as PPL-SLAM does.
  kPluckerLeft,
  // Two points, 6 parameters. Those along the line are free: no image determines them.
  kEndpoints,
};

// The two residuals of a line in an image, in pixels.
enum class LineResidualKind {
  // Distances of the measured ends from the projected infinite line (first paper, eq. 13).
  kObservedEnds,
  // Distances of the projected ends from the measured infinite line (second paper, eq. 1).
  kProjectedEnds,
};

// A kind of line in optimization. The residual determines the cost at the minimum, the parameters
// the convergence; docs/benchmarks.md compares their speed.
struct RivalLines {
  LineParametrization parametrization = LineParametrization::kPlucker;
  LineResidualKind residual = LineResidualKind::kObservedEnds;
};

// SolveLocalBa with another kind of line, by the same solver; the result is the same form of line.
//
// End points are blocks of 6: they begin at EndsOf(), the result has them at their final positions,
// and the lines go through them. Nothing constrains them along their lines. Under projected ends
// with diagonal covariances they are two landmarks a line, each with its own loss, since their
// blocks then share nothing. Other lines under projected ends have those of TrimmedEnds().
//
// BugError for axes under projected ends, which do not constrain lines to be parallel; otherwise as
// SolveLocalBa.
BaResult SolveRivalBa(const BaProblem& problem,
                      const LocalBaOptions& options,
                      const RivalLines& lines,
                      const StopCheck& stop = {});

}  // namespace plumbline
