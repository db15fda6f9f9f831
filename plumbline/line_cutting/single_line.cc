// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/single_line.h"

#include "plumbline/line_cutting/line_cut_objective.h"
#include "plumbline/line_cutting/ratio_ascent.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr double kStartLength = 0.02;
// A later start must be better by this, in log det, so that rounding does not decide.
constexpr double kClearlyBetter = 1e-9;

template <class Objective>
SingleLineCut BestOfThree(const Objective& objective, const LineCut& present) {
  Vector2d unused;
  const double value = objective({present.first, present.second}, unused);
  SingleLineCut best{present};
  for (const Vector2d& start :
       {Vector2d(0, 1), Vector2d(0, kStartLength), Vector2d(1 - kStartLength, 1)}) {
    const RatioAscent<2> found = Ascend<2>(objective, start);
    best.iterations += found.iterations;
    const double gain = found.value - value;
    if (!(gain > best.gain + kClearlyBetter)) continue;
    best.gain = gain;
    best.cut = {found.ratios.minCoeff(), found.ratios.maxCoeff()};
  }
  return best;
}

}  // namespace

SingleLineCut CutSingleLine(const CuttingProblem& problem,
                            std::size_t line,
                            const InformationSums& rest,
                            const LineCut& present,
                            CuttingInformation information) {
  if (information != CuttingInformation::kIndependent) {
    return BestOfThree(GeneralLineObjective(problem, line, rest, information), present);
  }
  const Matrix6d others = PoseInformation(rest, problem.other_information, information);
  return BestOfThree(IndependentLineObjective(problem.camera, problem.lines[line], others),
                     present);
}

}  // namespace plumbline
