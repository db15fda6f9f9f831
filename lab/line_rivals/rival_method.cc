// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/rival_method.h"

#include "lab/line_rivals/line_ends.h"
#include "lab/line_rivals/line_from_ends.h"
#include "lab/line_rivals/rival_ba.h"
#include "plumbline/tracking/projected_matches.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

template <LineParametrization kParametrization, LineResidualKind kResidual>
BaResult Solve(const BaProblem& problem, const LocalBaOptions& options, const StopCheck& stop) {
  return SolveRivalBa(problem, options, {kParametrization, kResidual}, stop);
}

template <LineResidualKind kResidual>
BaSolver SolverFor(LineParametrization parametrization) {
  switch (parametrization) {
    case LineParametrization::kPluckerLeft:
      return Solve<LineParametrization::kPluckerLeft, kResidual>;
    case LineParametrization::kEndpoints:
      return Solve<LineParametrization::kEndpoints, kResidual>;
    case LineParametrization::kPlucker:
      break;
  }
  return Solve<LineParametrization::kPlucker, kResidual>;
}

// The covariances of the measured ends become those of the ends that the solver will project.
void WeighProjectedEnds(const LineWeights& weights, BaProblem& problem) {
  problem.axes.clear();
  problem.parallel_lines.clear();
  const std::vector<Segment3> ends = EndsOf(problem);
  for (auto& o : problem.line_observations) {
    const auto line = static_cast<std::size_t>(o.line);
    UseProjectedEnds(problem.camera,
                     problem.poses[static_cast<std::size_t>(o.pose)].cam_from_world,
                     {ToPlucker(problem.lines[line]), ends[line]},
                     std::nullopt,  // the lines are free to move
                     weights,
                     o.measurement);
  }
}

std::optional<MapLine> LineFromTwoViews(const Map& map,
                                        const RectifiedCamera& camera,
                                        const std::vector<LineViewOf>& views) {
  if (views.size() > 2) return std::nullopt;
  return LineFromViews(map, camera, views);
}

}  // namespace

LineMethod MethodFor(const LineOptions& options) {
  LineMethod method = ProductLineMethod(options);
  method.parametrization = options.parametrization;
  method.reconstruction = options.reconstruction;
  method.keeps_ends = options.parametrization == LineParametrization::kEndpoints;
  if (options.reconstruction == LineReconstruction::kTwoView) {
    method.line_from_views = method.keeps_ends ? LineFromTwoEnds : LineFromTwoViews;
  }
  method.adjust_window = SolverFor<LineResidualKind::kObservedEnds>(options.parametrization);
  method.adjust_map = method.adjust_window;
  if (options.residual != LineResidualKind::kProjectedEnds) return method;
  method.complete_window = WeighProjectedEnds;
  method.adjust_window = SolverFor<LineResidualKind::kProjectedEnds>(options.parametrization);
  return method;
}

}  // namespace plumbline
