// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/gate.h"

#include "lab/experiments/catalog.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

GateLimit AtMost(const std::string& sequence, double value) {
  return {"pair", sequence, "one", "ate", "mm", value, std::nullopt};
}

TEST(Gate, HoldsTheWorstRunAgainstTheLimit) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  std::vector<JobResult> results(8, Success(4, "a"));
  results[1] = Success(6, "b");  // euroc/a, one, run 2
  GateLimit covered = AtMost("euroc/a", 0);
  covered.metric = "coverage";
  covered.at_most = std::nullopt;
  covered.at_least = 99;
  const auto checks =
      CheckGate({AtMost("euroc/a", 6), AtMost("euroc/a", 5.9), covered, AtMost("euroc/gone", 1)},
                plan,
                results);
  ASSERT_EQ(checks.size(), 3U) << "sequences that are not there have nothing to keep";
  EXPECT_FALSE(checks[0].kept);
  EXPECT_EQ(checks[0].limit.at_most, 5.9);
  EXPECT_EQ(checks[0].figure, 6);
  EXPECT_TRUE(checks[1].kept);
  EXPECT_TRUE(checks[2].kept);
  const std::string text = FormatGate(checks);
  EXPECT_THAT(text, HasSubstr("| **broken** | euroc/a | one | ate [mm] | 6 | at most 5.9 |"));
  EXPECT_THAT(text, HasSubstr("| kept | euroc/a | one | coverage [mm] | 100 | at least 99 |"));
}

TEST(Gate, HoldsTheMeanOfTheRunsAgainstALimitOfMeans) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  std::vector<JobResult> results(8, Success(4, "a"));
  results[1] = Success(6, "b");  // euroc/a, one, run 2
  GateLimit mean = AtMost("euroc/a", 5), broken = AtMost("euroc/a", 4.9);
  mean.of_mean = broken.of_mean = true;
  const auto checks = CheckGate({mean, broken}, plan, results);
  ASSERT_EQ(checks.size(), 2U);
  EXPECT_FALSE(checks[0].kept);
  EXPECT_TRUE(checks[1].kept);
  EXPECT_EQ(checks[1].figure, 5);
  EXPECT_THAT(FormatGate(checks),
              HasSubstr("| **broken** | euroc/a | one | mean ate [mm] | 5 | at most 4.9 |"));
}

TEST(Gate, ARunWithoutTheFigureBreaksTheLimit) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  std::vector<JobResult> results(8, Success(4, "a"));
  results[0] = NoResult("crashed");
  results[4].figures->values.erase("ate");
  results[4].figures->reasons["ate"] = "no ground truth";
  const auto checks = CheckGate({AtMost("euroc/a", 6), AtMost("euroc/b", 6)}, plan, results);
  ASSERT_EQ(checks.size(), 2U);
  EXPECT_FALSE(checks[0].kept);
  EXPECT_EQ(checks[0].reason, "crashed");
  EXPECT_FALSE(checks[1].kept);
  EXPECT_EQ(checks[1].reason, "no ground truth");
}

TEST(GateLimits, AreWholeAndBelongToTheExperiment) {
  for (const char* experiment : {"gate", "gate_lines"}) {
    const std::vector<GateLimit> limits = GateLimitsOf(experiment);
    EXPECT_GT(limits.size(), 5U) << experiment;
    std::vector<std::string> patterns;
    for (const SequenceChoice& choice : FindExperiment(experiment).sequences) {
      patterns.push_back(choice.pattern + (choice.label.empty() ? "" : "@" + choice.label));
    }
    for (const GateLimit& limit : limits) {
      EXPECT_THAT(patterns, testing::Contains(limit.sequence));
    }
  }
  EXPECT_TRUE(GateLimitsOf("sensors").empty());
}

TEST(GateLimits, OtherTextIsRefusedWithItsPlace) {
  const auto message = [](const std::string& text) {
    return MessageOf([&] { ParseGateLimits({"limits.yaml", text.c_str()}); });
  };
  const std::string begin =
      "# limits\n- {experiment: gate, sequence: worlds/room, variant: both, metric: ate, unit: ";
  EXPECT_THAT(message(begin + "cm, at_most: 1}\n"),
              HasSubstr("limits.yaml:2: ate: expected the unit mm"));
  EXPECT_THAT(message(begin + "mm}\n"), HasSubstr("expected one of at_most and at_least"));
  EXPECT_THAT(message(begin + "mm, at_most: x}\n"), HasSubstr("at_most: expected a number"));
  EXPECT_THAT(message(begin + "mm, at_most: 1, of: median}\n"),
              HasSubstr("limits.yaml:2: of: expected mean or worst, found median"));
  EXPECT_THAT(message(begin + "mm, most: 1}\n"), HasSubstr("unknown key most"));
  EXPECT_THAT(message("limits: []\n"), HasSubstr("limits.yaml: expected a list of limits"));
  std::string other = begin + "mm, at_most: 1}\n";
  other.replace(other.find("both"), 4, "none");
  EXPECT_THAT(message(other), HasSubstr("gate has no variant none"));
}

}  // namespace
}  // namespace plumbline
