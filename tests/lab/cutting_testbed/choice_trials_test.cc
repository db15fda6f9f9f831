// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/choice_trials.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ChoiceTrials, TogetherIsNearTheBestOfAllSubsetsAndAboveTheOthers) {
  double together = 0, apart = 0, whole = 0, random = 0, best = 0;
  for (std::uint64_t index = 0; index < 5; ++index) {
    const ChoiceTrial trial = TryChoices({5, 5, 6, true}, index);
    ASSERT_EQ(trial.log_determinant.size(), 6U);
    for (const auto& [variant, value] : trial.log_determinant) {
      EXPECT_LE(value, trial.best) << NameOf(variant);
    }
    best += trial.best / 5;
    together += trial.log_determinant.at(ChoiceVariant::kTogetherSweeps) / 5;
    apart += trial.log_determinant.at(ChoiceVariant::kApart) / 5;
    whole += trial.log_determinant.at(ChoiceVariant::kWhole) / 5;
    random += trial.log_determinant.at(ChoiceVariant::kRandom) / 5;
  }
  EXPECT_GT(together, best - 0.5);
  EXPECT_GT(together, apart);
  EXPECT_GT(together, whole);
  EXPECT_GT(whole, random);
}

TEST(ChoiceTrials, OfManyFeaturesTheBestIsTheBestVariant) {
  const ChoiceTrial trial = TryChoices({40, 15, 20, false}, 1);
  double best = -1e9;
  for (const auto& [variant, value] : trial.log_determinant) best = std::max(best, value);
  EXPECT_EQ(trial.best, best);
}

}  // namespace
}  // namespace plumbline
