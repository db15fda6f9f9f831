// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/joint_optimizers.h"

#include "lab/cutting_testbed/scene.h"

#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr auto kIndependent = CuttingInformation::kIndependent;

class JointOptimizers : public ::testing::TestWithParam<JointOptimizer> {};

TEST_P(JointOptimizers, RaiseTheInformationInsideTheBox) {
  for (std::uint64_t index = 0; index < 3; ++index) {
    const CuttingScene scene = MakeCuttingScene({SceneKind::kInverseDepthPoints, 0.005, 10}, index);
    const JointObjective objective(scene.problem, kIndependent);
    Eigen::VectorXd gradient;
    const double full = objective(objective.FullLength(), gradient);
    const Eigen::VectorXd ratios = OptimizeJointly(scene.problem, kIndependent, GetParam());
    ASSERT_EQ(ratios.size(), 20);
    EXPECT_GE(ratios.minCoeff(), 0);
    EXPECT_LE(ratios.maxCoeff(), 1);
    const double value = objective(ratios, gradient);
    if (GetParam() == JointOptimizer::kFull) {
      EXPECT_EQ(value, full);
      continue;
    }
    EXPECT_GT(value, full + 0.3);
    // Greedy leaves its first lines behind; the others end where no step inside the box helps.
    const Eigen::VectorXd free = (ratios + 0.01 * gradient).cwiseMax(0.0).cwiseMin(1.0) - ratios;
    if (GetParam() != JointOptimizer::kGreedy) {
      EXPECT_LT(free.lpNorm<Eigen::Infinity>(), 1e-3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All,
                         JointOptimizers,
                         ::testing::Values(JointOptimizer::kFull,
                                           JointOptimizer::kGreedy,
                                           JointOptimizer::kSweeps,
                                           JointOptimizer::kSpectral,
                                           JointOptimizer::kIpopt,
                                           JointOptimizer::kSlsqp,
                                           JointOptimizer::kMma,
                                           JointOptimizer::kLbfgs),
                         [](const auto& optimizer) { return NameOf(optimizer.param); });

TEST(JointObjective, KnowsFullLength) {
  const CuttingScene scene = MakeCuttingScene({SceneKind::kHomogeneousPoints, 0.005, 6}, 1);
  const JointObjective objective(scene.problem, kIndependent);
  EXPECT_EQ(objective.size(), 12);
  EXPECT_EQ(objective.FullLength()(4), 0);
  EXPECT_EQ(objective.FullLength()(5), 1);
  Eigen::VectorXd gradient;
  EXPECT_TRUE(std::isfinite(objective(objective.FullLength(), gradient)));
}

}  // namespace
}  // namespace plumbline
