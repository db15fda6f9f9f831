// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/single_line_trials.h"

#include "lab/cutting_testbed/grid_search.h"
#include "plumbline/base/error.h"
#include "plumbline/line_cutting/line_cut_objective.h"
#include "plumbline/line_cutting/pose_information.h"
#include "plumbline/line_cutting/ratio_ascent.h"
#include "plumbline/line_cutting/single_line.h"

#include <algorithm>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr int kSurfaceSteps = 50;

template <class Objective>
GridMaximum AscendFrom(const Objective& objective, AscentStarts starts) {
  std::vector<Vector2d> list{{0, 1}};
  if (starts == AscentStarts::kPaper) list.insert(list.end(), {{0, 0}, {1, 1}});
  GridMaximum best;
  for (const Vector2d& start : list) {
    const RatioAscent<2> found = Ascend<2>(objective, start);
    if (found.value > best.value) best = {found.ratios, found.value};
  }
  return best;
}

InformationSums RestOf(const CuttingProblem& problem,
                       std::size_t line,
                       CuttingInformation information) {
  std::vector<LineCut> cuts(problem.lines.size());
  cuts[line].used = false;
  return SumInformation(problem, cuts, information);
}

IndependentLineObjective IndependentObjective(const CuttingProblem& problem, std::size_t line) {
  const auto kind = CuttingInformation::kIndependent;
  return {problem.camera,
          problem.lines[line],
          PoseInformation(RestOf(problem, line, kind), problem.other_information, kind)};
}

template <class Objective>
SingleLineTrial Compare(const Objective& objective,
                        AscentStarts starts,
                        const SingleLineCut& three_starts) {
  const GridMaximum grid = SearchGrid(objective, kGridSteps);
  GridMaximum ascent;
  if (starts == AscentStarts::kThree) {
    Vector2d gradient;
    ascent.ratios = {three_starts.cut.first, three_starts.cut.second};
    ascent.value = objective(ascent.ratios, gradient);
  } else {
    ascent = AscendFrom(objective, starts);
  }
  return {
      grid.ratios, {ascent.ratios.minCoeff(), ascent.ratios.maxCoeff()}, grid.value - ascent.value};
}

bool HasShape(const Vector2d& best, SurfaceShape shape) {
  switch (shape) {
    case SurfaceShape::kFullLength:
      return best.x() == 0 && best.y() == 1;
    case SurfaceShape::kPiece:
      return best.x() == 0 && best.y() > 0.5 && best.y() < 0.9;
    case SurfaceShape::kPoint:
      return best.x() == best.y() && best.x() > 0.2 && best.x() < 0.8;
  }
  throw BugError("no such shape");
}

}  // namespace

std::vector<SingleLineTrial> TrySingleLines(const CuttingScene& scene,
                                            CuttingInformation information,
                                            AscentStarts starts,
                                            std::size_t max_lines) {
  const CuttingProblem& problem = scene.problem;
  std::vector<SingleLineTrial> trials;
  for (std::size_t i = 0; i < std::min(problem.lines.size(), max_lines); ++i) {
    const InformationSums rest = RestOf(problem, i, information);
    const SingleLineCut cut = CutSingleLine(problem, i, rest, {}, information);
    if (information == CuttingInformation::kIndependent) {
      trials.push_back(Compare(IndependentObjective(problem, i), starts, cut));
    } else {
      trials.push_back(Compare(GeneralLineObjective(problem, i, rest, information), starts, cut));
    }
  }
  return trials;
}

SurfaceExample FindSurface(const SceneOptions& options, SurfaceShape shape) {
  for (std::uint64_t index = 0; index < 1000; ++index) {
    const CuttingProblem problem = MakeCuttingScene(options, index).problem;
    for (std::size_t i = 0; i < problem.lines.size(); ++i) {
      const IndependentLineObjective objective = IndependentObjective(problem, i);
      const GridMaximum best = SearchGrid(objective, kSurfaceSteps);
      if (HasShape(best.ratios, shape)) return {SurfaceOf(objective, kSurfaceSteps), best.ratios};
    }
  }
  throw BugError("no scene has such a surface");
}

}  // namespace plumbline
