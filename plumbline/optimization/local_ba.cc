// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/local_ba.h"

#include "plumbline/optimization/bundle_adjuster.h"
#include "plumbline/optimization/check_problem.h"

namespace plumbline {

BaResult SolveLocalBa(const BaProblem& problem,
                      const LocalBaOptions& options,
                      const StopCheck& stop) {
  CheckIndices(problem);
  if (!IsFinite(problem)) return NotFinite(problem);
  BundleAdjuster<BaLine> adjuster(
      problem, problem.lines, LineObservationsOf<BaLine>(problem), options, stop);
  BaResult result = adjuster.Solve();
  result.lines = adjuster.lines();
  return result;
}

}  // namespace plumbline
