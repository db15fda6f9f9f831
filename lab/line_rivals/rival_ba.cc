// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/rival_ba.h"

#include "lab/line_rivals/ba_projected_ends.h"
#include "lab/line_rivals/ba_rival_lines.h"
#include "lab/line_rivals/line_ends.h"
#include "plumbline/base/error.h"
#include "plumbline/optimization/bundle_adjuster.h"
#include "plumbline/optimization/problem.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// Two landmarks for each line: start and end.
std::vector<BaObservation<BaLineEnd::Term>> ObservationsOfEnds(const BaProblem& problem) {
  std::vector<BaObservation<BaLineEnd::Term>> out;
  out.reserve(2 * problem.line_observations.size());
  for (const auto& o : problem.line_observations) {
    const auto [start, end] = BaLineEnd::MakeTerms(problem.camera, o.measurement);
    out.push_back({o.pose, 2 * o.line, start});
    out.push_back({o.pose, 2 * o.line + 1, end});
  }
  return out;
}

// Line: BaLine or BaLineLeft.
template <class Line>
BaResult SolveWithLines(const BaProblem& problem,
                        const LocalBaOptions& options,
                        const StopCheck& stop) {
  BundleAdjuster<Line> adjuster(
      problem, problem.lines, LineObservationsOf<Line>(problem), options, stop);
  BaResult result = adjuster.Solve();
  result.lines = adjuster.lines();
  return result;
}

// Lines with ends at fixed parameters along them.
template <class Line>
BaResult SolveWithProjectedLines(const BaProblem& problem,
                                 const LocalBaOptions& options,
                                 const StopCheck& stop) {
  const std::vector<Segment3> ends = TrimmedEnds(problem);
  std::vector<LineWithEnds> states;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const PluckerLine line = ToPlucker(problem.lines[i]);
    states.push_back(
        {problem.lines[i], {line.ParameterOf(ends[i].start), line.ParameterOf(ends[i].end)}});
  }
  using Kind = BaProjectedLine<Line>;
  BundleAdjuster<Kind> adjuster(
      problem, std::move(states), LineObservationsOf<Kind>(problem), options, stop);
  BaResult result = adjuster.Solve();
  for (const LineWithEnds& state : adjuster.lines()) result.lines.push_back(state.line);
  return result;
}

void TakeEnds(const BaProblem& problem,
              const std::vector<Segment3>& before,
              const std::vector<Segment3>& moved,
              BaResult& result) {
  result.line_ends = EndsOfLines(before, moved);
  result.lines = LinesThroughEnds(problem.lines, before, result.line_ends);
}

// Ends: BaLineEnds or BaProjectedEnds.
template <class Ends>
BaResult SolveWithEnds(const BaProblem& problem,
                       const LocalBaOptions& options,
                       const StopCheck& stop) {
  const std::vector<Segment3> ends = EndsOf(problem);
  BundleAdjuster<Ends> adjuster(problem, ends, LineObservationsOf<Ends>(problem), options, stop);
  BaResult result = adjuster.Solve();
  TakeEnds(problem, ends, adjuster.lines(), result);
  return result;
}

bool AllDiagonal(const BaProblem& problem) {
  const auto& observations = problem.line_observations;
  return std::all_of(observations.begin(), observations.end(), [](const auto& o) {
    return o.measurement.covariance(0, 1) == 0 && o.measurement.covariance(1, 0) == 0;
  });
}

// Starts and ends as landmarks of their own. An observation of a line counts when both count.
BaResult SolveWithSeparateEnds(const BaProblem& problem,
                               const LocalBaOptions& options,
                               const StopCheck& stop) {
  const std::vector<Segment3> ends = EndsOf(problem);
  std::vector<BaLineEnd::State> states;
  for (const Segment3& s : ends) {
    states.push_back({s.start, s.end - s.start});
    states.push_back({s.end, s.end - s.start});
  }
  BundleAdjuster<BaLineEnd> adjuster(
      problem, std::move(states), ObservationsOfEnds(problem), options, stop);
  BaResult result = adjuster.Solve();
  std::vector<Segment3> moved;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    moved.push_back({adjuster.lines()[2 * i].point, adjuster.lines()[2 * i + 1].point});
  }
  TakeEnds(problem, ends, moved, result);
  for (std::size_t k = 0; k < problem.line_observations.size(); ++k) {
    result.line_chi2[k] = result.line_chi2[2 * k] + result.line_chi2[2 * k + 1];
    result.line_inliers[k] = result.line_inliers[2 * k] && result.line_inliers[2 * k + 1];
  }
  result.line_chi2.resize(problem.line_observations.size());
  result.line_inliers.resize(problem.line_observations.size());
  return result;
}

}  // namespace

BaResult SolveRivalBa(const BaProblem& problem,
                      const LocalBaOptions& options,
                      const RivalLines& lines,
                      const StopCheck& stop) {
  CheckIndices(problem);
  const bool projected = lines.residual == LineResidualKind::kProjectedEnds;
  PLUMBLINE_CHECK(!projected || problem.axes.empty(), "axes need the residual observed_ends");
  if (!IsFinite(problem)) return NotFinite(problem);
  switch (lines.parametrization) {
    case LineParametrization::kPluckerLeft:
      return projected ? SolveWithProjectedLines<BaLineLeft>(problem, options, stop)
                       : SolveWithLines<BaLineLeft>(problem, options, stop);
    case LineParametrization::kEndpoints:
      if (!projected) return SolveWithEnds<BaLineEnds>(problem, options, stop);
      return AllDiagonal(problem) ? SolveWithSeparateEnds(problem, options, stop)
                                  : SolveWithEnds<BaProjectedEnds>(problem, options, stop);
    case LineParametrization::kPlucker:
      break;
  }
  return projected ? SolveWithProjectedLines<BaLine>(problem, options, stop)
                   : SolveLocalBa(problem, options, stop);
}

}  // namespace plumbline
