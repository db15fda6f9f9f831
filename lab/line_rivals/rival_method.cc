// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/rival_method.h"

#include "lab/line_rivals/line_classes.h"
#include "lab/line_rivals/line_ends.h"
#include "lab/line_rivals/line_from_ends.h"
#include "plumbline/tracking/projected_matches.h"

#include <cstddef>
#include <optional>
#include <type_traits>
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

RivalLines RivalLinesOf(const std::string& residual) {
  RivalLines lines;
  if (residual.starts_with("projected_")) lines.residual = LineResidualKind::kProjectedEnds;
  if (residual.ends_with("plucker_left")) lines.parametrization = LineParametrization::kPluckerLeft;
  if (residual.ends_with("endpoints")) lines.parametrization = LineParametrization::kEndpoints;
  return lines;
}

std::vector<AddedMethod> AddedLineMethods() {
  const std::string residual = "lines.residual";
  std::vector<AddedMethod> added = {
      {residual, "plucker_left", "observed_ends, of lines turned about the axes of the frame"},
      {residual, "projected_plucker_left", "projected_ends of the same"},
      {residual, "endpoints", "observed_ends, of lines that are two points"},
      {residual, "projected_endpoints", "projected_ends of the same"},
      {"lines.reconstruction", "two_view", "the closest pair that agrees"}};
  for (const auto& [which, name] : EnumNames(std::type_identity<LineClass>{})) {
    added.push_back({"lines.reconstruction",
                     std::string("without_") + name,
                     std::string("n_view without a class of lines: ") + name});
  }
  return added;
}

LineMethod MethodFor(const LineOptions& options) {
  const auto [parametrization, residual] = RivalLinesOf(options.residual);
  LineOptions of_product = options;
  const bool projected = residual == LineResidualKind::kProjectedEnds;
  of_product.residual = projected ? "projected_ends" : "observed_ends";
  LineMethod method = ProductLineMethod(of_product);
  method.keeps_ends = parametrization == LineParametrization::kEndpoints;
  if (options.reconstruction == "two_view") {
    method.line_from_views = method.keeps_ends ? LineFromTwoEnds : LineFromTwoViews;
  }
  if (const auto without = LinesWithoutClass(options.reconstruction)) {
    method.line_from_views = without;
  }
  method.adjust_window = SolverFor<LineResidualKind::kObservedEnds>(parametrization);
  method.adjust_map = method.adjust_window;
  if (!projected) return method;
  method.only_odometry = false;
  method.complete_window = WeighProjectedEnds;
  method.adjust_window = SolverFor<LineResidualKind::kProjectedEnds>(parametrization);
  return method;
}

}  // namespace plumbline
