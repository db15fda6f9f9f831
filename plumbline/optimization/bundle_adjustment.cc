// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/bundle_adjustment.h"

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/bundle_adjuster.h"
#include "plumbline/optimization/problem.h"

#include <cstddef>
#include <optional>
#include <string>

namespace plumbline {

namespace {

// The problem with normalized rotations, if some are off by more than rounding; nullopt: none is.
// Throws InputError for an invalid rotation.
std::optional<BaProblem> Normalized(const BaProblem& problem) {
  std::optional<BaProblem> normalized;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    const Eigen::Quaterniond& given = problem.poses[i].cam_from_world.rotation;
    if (!IsRotation(given)) UnitRotation(given, "poses[" + std::to_string(i) + "]");  // throws
    const Eigen::Quaterniond unit = UnitRotation(given, "poses");
    if (unit.coeffs() == given.coeffs()) continue;
    if (!normalized) normalized = problem;
    normalized->poses[i].cam_from_world.rotation = unit;
  }
  return normalized;
}

}  // namespace

BaResult SolveLocalBa(const BaProblem& problem,
                      const LocalBaOptions& options,
                      const StopCheck& stop) {
  CheckIndices(problem);
  if (!IsFinite(problem)) return NotFinite(problem);
  if (const auto normalized = Normalized(problem)) {
    return SolveLocalBa(*normalized, options, stop);
  }
  BundleAdjuster<BaLine> adjuster(
      problem, problem.lines, LineObservationsOf<BaLine>(problem), options, stop);
  BaResult result = adjuster.Solve();
  result.lines = adjuster.lines();
  return result;
}

}  // namespace plumbline
