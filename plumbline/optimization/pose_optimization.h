// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/problem.h"

namespace plumbline {

// Estimates a camera pose from matches with points and lines of a known map.
//
// Levenberg-Marquardt on the whitened residuals of residuals.h (eq. 13 for lines) with the left
// perturbation exp([w, v]) T (eq. 20). After each round all matches, even rejected ones, are
// classified by chi2 at 95 %: points with 2 degrees of freedom (3 with disparity), all measurements
// of one line group together with 2 each. A point behind the camera is an outlier. The initial pose
// may be wrong by tens of pixels, with 30 % of the matches wrong. The contribution of a point's own
// covariance to its residual is computed at the initial pose (UncertainPointTerm).
//
//   problem   measurements in pixels, landmarks in the world, the initial pose
//   returns   always a result; judge it by `converged` and the counts of inliers
//   cost      about 0.2 ms for 300 points and 80 lines; no allocation inside the iterations
PoseOnlyResult SolvePose(const PoseProblem& problem, const PoseOnlyOptions& options = {});

}  // namespace plumbline
