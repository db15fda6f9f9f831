// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/cutting_methods.h"

#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/line_cutting/pose_information.h"

#include "tests/line_cutting/random_lines.h"
#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

double Value(const CuttingProblem& problem, const CuttingRecipe& recipe) {
  return LogDeterminantOf(problem, CutLinesBy(recipe, problem), recipe.information);
}

TEST(CutLinesBy, RaisesTheInformationThatIsAskedFor) {
  for (const auto kind : {CuttingInformation::kIndependent, CuttingInformation::kPrinted}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const CuttingProblem problem = RandomProblem(seed, 12);
      const double full = Value(problem, {CuttingMethod::kNone, kind});
      const double greedy = Value(problem, {CuttingMethod::kGreedy, kind});
      const double sweeps = Value(problem, {CuttingMethod::kGreedySweeps, kind});
      const double joint = Value(problem, {CuttingMethod::kJoint, kind});
      EXPECT_GT(greedy, full + 0.1);
      EXPECT_GE(sweeps, greedy - 1e-9);
      EXPECT_GT(joint, full + 0.1);
    }
  }
}

TEST(CutLinesBy, JointGainsNothingInTheCorrelatedInformation) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const CuttingProblem problem = RandomProblem(seed, 12);
    const auto kind = CuttingInformation::kCorrelated;
    const double full = Value(problem, {CuttingMethod::kNone, kind});
    const double joint = Value(problem, {CuttingMethod::kJoint, kind});
    EXPECT_GE(joint, full);
    EXPECT_LT(joint, full + 1e-3);
  }
}

TEST(CutLinesBy, CutsLieOnTheLineInOrder) {
  const CuttingProblem problem = RandomProblem(5, 30);
  for (const auto method :
       {CuttingMethod::kGreedy, CuttingMethod::kGreedySweeps, CuttingMethod::kJoint}) {
    for (const LineCut& cut : CutLinesBy({method}, problem)) {
      EXPECT_TRUE(cut.used);
      EXPECT_GE(cut.first, 0);
      EXPECT_LE(cut.first, cut.second);
      EXPECT_LE(cut.second, 1);
    }
  }
}

TEST(CutLinesBy, LeavesOutTheMostUncertain) {
  CuttingProblem problem = RandomProblem(6, 10);
  for (const std::size_t i : {1U, 4U, 7U}) {
    problem.lines[i].start_covariance *= 1e4;
    problem.lines[i].end_covariance *= 1e4;
  }
  const auto cuts = CutLinesBy({.method = CuttingMethod::kDrop}, problem);
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    EXPECT_EQ(cuts[i].used, i != 1 && i != 4 && i != 7);
    EXPECT_EQ(cuts[i].first, 0);
    EXPECT_EQ(cuts[i].second, 1);
  }
  const auto all = CutLinesBy({.method = CuttingMethod::kDrop, .drop_share = 1}, problem);
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const LineCut& c) { return c.used; }), 4);
}

TEST(CutLinesBy, DoesNothingUnlessAsked) {
  const CuttingProblem problem = RandomProblem(7, 5);
  EXPECT_EQ(CutLinesBy({}, problem), std::vector<LineCut>(5));
  EXPECT_TRUE(CutLinesBy({CuttingMethod::kGreedySweeps}, {}).empty());
}

TEST(CutLinesBy, KeepsLinesWholeWhereThePrintedInformationIsNone) {
  const CuttingProblem problem = RandomProblem(10, 2);  // l^T H_x has rank 4
  for (const auto method : {CuttingMethod::kGreedySweeps, CuttingMethod::kJoint}) {
    EXPECT_EQ(CutLinesBy({method, CuttingInformation::kPrinted}, problem), std::vector<LineCut>(2));
  }
}

}  // namespace
}  // namespace plumbline
