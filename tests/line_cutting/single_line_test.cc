// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/single_line.h"

#include "plumbline/line_cutting/line_cut_objective.h"

#include "tests/line_cutting/random_lines.h"
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;

struct Brute {
  double value = -std::numeric_limits<double>::infinity();
  Vector2d ratios;
};
template <class Objective>
Brute BestOnGrid(const Objective& objective, int steps) {
  Brute best;
  Vector2d unused;
  for (int i = 0; i <= steps; ++i) {
    for (int k = i; k <= steps; ++k) {
      const Vector2d ratios(i / static_cast<double>(steps), k / static_cast<double>(steps));
      const double value = objective(ratios, unused);
      if (value > best.value) best = {value, ratios};
    }
  }
  return best;
}

InformationSums RestOf(const CuttingProblem& problem, std::size_t line, CuttingInformation kind) {
  std::vector<LineCut> cuts(problem.lines.size());
  cuts[line].used = false;
  return SumInformation(problem, cuts, kind);
}

TEST(CutSingleLine, AgreesWithBruteForce) {
  int agreed = 0, total = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const CuttingProblem problem = RandomProblem(seed, 8);
    for (std::size_t i = 0; i < problem.lines.size(); ++i) {
      const auto kind = CuttingInformation::kIndependent;
      const InformationSums rest = RestOf(problem, i, kind);
      const IndependentLineObjective objective(
          problem.camera, problem.lines[i], PoseInformation(rest, problem.other_information, kind));
      const Brute brute = BestOnGrid(objective, 100);
      const SingleLineCut found = CutSingleLine(problem, i, rest, {}, kind);
      Vector2d unused;
      agreed += objective({found.cut.first, found.cut.second}, unused) > brute.value - 1e-4;
      ++total;
    }
  }
  EXPECT_GE(agreed, 0.99 * total);
}

TEST(CutSingleLine, AgreesWithBruteForceForThePrintedInformation) {
  int agreed = 0, total = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const CuttingProblem problem = RandomProblem(seed, 8);
    const InformationSums rest = RestOf(problem, 0, CuttingInformation::kPrinted);
    const GeneralLineObjective objective(problem, 0, rest, CuttingInformation::kPrinted);
    const Brute brute = BestOnGrid(objective, 25);
    const SingleLineCut found = CutSingleLine(problem, 0, rest, {}, CuttingInformation::kPrinted);
    Vector2d unused;
    agreed += objective({found.cut.first, found.cut.second}, unused) > brute.value - 1e-3;
    ++total;
  }
  EXPECT_GE(agreed, 0.9 * total);
}

TEST(CutSingleLine, KeepsAPresentCutThatIsAsGood) {
  const CuttingProblem problem = RandomProblem(3, 8);
  const auto kind = CuttingInformation::kIndependent;
  const InformationSums rest = RestOf(problem, 2, kind);
  const SingleLineCut found = CutSingleLine(problem, 2, rest, {}, kind);
  EXPECT_GE(found.gain, 0);
  const SingleLineCut again = CutSingleLine(problem, 2, rest, found.cut, kind);
  EXPECT_EQ(again.cut, found.cut);
  EXPECT_EQ(again.gain, 0);
}

}  // namespace
}  // namespace plumbline
