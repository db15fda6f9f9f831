// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/line_cut_objective.h"

#include "tests/line_cutting/random_lines.h"
#include "tests/support/jacobian.h"
#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Vector1d = Eigen::Matrix<double, 1, 1>;

struct Rest {
  InformationSums sums;
  Matrix6d information;
};
Rest WithoutTheFirst(const CuttingProblem& problem, CuttingInformation kind) {
  std::vector<LineCut> cuts(problem.lines.size());
  cuts.front().used = false;
  Rest rest{SumInformation(problem, cuts, kind), {}};
  rest.information = PoseInformation(rest.sums, problem.other_information, kind);
  return rest;
}

TEST(IndependentLineObjective, DiffersFromTheLogDeterminantByAConstant) {
  const CuttingProblem problem = RandomProblem(1, 6, 4);
  const Rest rest = WithoutTheFirst(problem, CuttingInformation::kIndependent);
  const IndependentLineObjective objective(problem.camera, problem.lines.front(), rest.information);
  const GeneralLineObjective general(problem, 0, rest.sums, CuttingInformation::kIndependent);
  const double constant = std::log(rest.information.determinant());
  Rng rng(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector2d ratios(rng.Uniform(), rng.Uniform());
    Vector2d fast, reference;
    const double value = objective(ratios, fast);
    EXPECT_NEAR(value + constant, general(ratios, reference), 1e-8);
    EXPECT_LT((fast - reference).norm(), 1e-7 * (1 + reference.norm()));
  }
}

TEST(LineObjectives, HaveTheGradientOfDifferences) {
  const CuttingProblem problem = RandomProblem(3, 5, 4);
  for (const CuttingInformation kind : {CuttingInformation::kIndependent,
                                        CuttingInformation::kPrinted,
                                        CuttingInformation::kCorrelated}) {
    const Rest rest = WithoutTheFirst(problem, kind);
    const GeneralLineObjective objective(problem, 0, rest.sums, kind);
    const Vector2d ratios(0.3, 0.6);
    Vector2d gradient, unused;
    objective(ratios, gradient);
    const auto numeric = NumericJacobian(
        [&](const Vector2d& a) { return Vector1d(objective(a, unused)); }, ratios, 1e-4);
    EXPECT_LT((gradient.transpose() - numeric).norm(), 1e-5 * (1 + numeric.norm()));
  }
}

TEST(IndependentLineObjective, HasTheSameGradientForBothRatiosOfAPoint) {
  const CuttingProblem problem = RandomProblem(4, 5);
  const Rest rest = WithoutTheFirst(problem, CuttingInformation::kIndependent);
  const IndependentLineObjective objective(problem.camera, problem.lines.front(), rest.information);
  Vector2d gradient;
  objective({0.3, 0.3}, gradient);
  EXPECT_DOUBLE_EQ(gradient(0), gradient(1));
}

}  // namespace
}  // namespace plumbline
