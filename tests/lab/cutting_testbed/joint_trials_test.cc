// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/joint_trials.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(JointTrials, NoOptimizerIsAboveTheBestAndSweepsAreNear) {
  for (std::uint64_t index = 0; index < 3; ++index) {
    const CuttingScene scene = MakeCuttingScene({SceneKind::kHomogeneousPoints, 0.015, 10}, index);
    const JointTrial trial = TryJointly(scene, CuttingInformation::kIndependent, index);
    ASSERT_EQ(trial.outcomes.size(), 8U);
    for (const auto& [optimizer, outcome] : trial.outcomes) {
      EXPECT_LE(outcome.log_determinant, trial.best) << NameOf(optimizer);
      EXPECT_GE(outcome.microseconds, 0);
    }
    EXPECT_LT(trial.outcomes.at(JointOptimizer::kFull).log_determinant, trial.best - 0.3);
    EXPECT_GT(trial.outcomes.at(JointOptimizer::kSweeps).log_determinant, trial.best - 0.1);
  }
}

}  // namespace
}  // namespace plumbline
