// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_solve.h"

#include "lab/line_rivals/rival_ba.h"
#include "plumbline/optimization/pose_optimization.h"

#include "tests/optimization/ba_scene.h"
#include "tests/optimization/pose_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::MakeBaScene;
using testing::MakePoseScene;

struct Case {
  LineParametrization lines;
  CeresDerivatives derivatives;
  bool robust;
  LineResidualKind residual = LineResidualKind::kObservedEnds;
};

class SolveWithCeresTest : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Cases,
    SolveWithCeresTest,
    ::testing::Values(Case{LineParametrization::kPlucker, CeresDerivatives::kAnalytic, false},
                      Case{LineParametrization::kPlucker, CeresDerivatives::kAnalytic, true},
                      Case{LineParametrization::kPlucker, CeresDerivatives::kAutomatic, true},
                      Case{LineParametrization::kPlucker,
                           CeresDerivatives::kAutomatic,
                           false,
                           LineResidualKind::kProjectedEnds},
                      Case{LineParametrization::kPluckerLeft, CeresDerivatives::kAnalytic, true},
                      Case{LineParametrization::kPluckerLeft, CeresDerivatives::kAutomatic, true},
                      Case{LineParametrization::kPluckerLeft,
                           CeresDerivatives::kAutomatic,
                           false,
                           LineResidualKind::kProjectedEnds},
                      Case{LineParametrization::kEndpoints, CeresDerivatives::kAnalytic, false},
                      Case{LineParametrization::kEndpoints, CeresDerivatives::kAnalytic, true},
                      Case{LineParametrization::kEndpoints, CeresDerivatives::kAutomatic, true}));

TEST_P(SolveWithCeresTest, AndOurSolverReachTheSameCost) {
  const auto [lines, derivatives, robust, residual] = GetParam();
  const LocalBaOptions options{
      .rounds = 1, .max_iterations = 300, .function_tolerance = 1e-13, .robust = robust};
  for (unsigned seed = 0; seed < 3; ++seed) {
    const auto scene = MakeBaScene(
        seed, {.points = 150, .lines = 40, .sigma = 1, .outliers = robust ? 0.05 : 0.0});
    const BaResult ours = SolveRivalBa(scene.problem, options, {lines, residual});
    const CeresBaResult reference =
        SolveWithCeres(scene.problem,
                       {.huber = robust ? kHuberThresholds : HuberThresholds{},
                        .derivatives = derivatives,
                        .lines = {lines, residual},
                        .max_iterations = 300,
                        .function_tolerance = 1e-13});
    EXPECT_NEAR(ours.initial_cost, reference.initial_cost, 1e-9 * reference.initial_cost);
    EXPECT_NEAR(ours.final_cost, reference.final_cost, 1e-6 * reference.final_cost)
        << "seed " << seed << " iterations " << ours.iterations << " and " << reference.iterations;
    for (std::size_t i = 0; i < ours.poses.size(); ++i) {
      EXPECT_LT(LogSe3(ours.poses[i] * Inverse(reference.poses[i])).norm(), 1e-3);
    }
  }
}

TEST(SolvePoseWithCeres, FindsThePoseAndTheInliersOfOurSolver) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const auto scene = MakePoseScene(seed,
                                     {.points = 300,
                                      .lines = 40,
                                      .sigma = 1,
                                      .outliers = 0.1,
                                      .rotation_error = 0.005,
                                      .translation_error = 0.05});
    const PoseOnlyResult ours = SolvePose(scene.problem);
    const CeresPoseResult reference =
        SolvePoseWithCeres(scene.problem, {.huber = kHuberThresholds});
    EXPECT_LT(LogSe3(ours.cam_from_world * Inverse(reference.cam_from_world)).norm(), 1e-3) << seed;
    EXPECT_NEAR(ours.inlier_points, reference.inlier_points, 3);
    EXPECT_NEAR(ours.inlier_line_groups, reference.inlier_line_groups, 2);
  }
}

}  // namespace
}  // namespace plumbline
