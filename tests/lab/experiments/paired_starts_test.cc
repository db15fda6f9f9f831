// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paired_starts.h"

#include "lab/experiments/write_results.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/start_fixtures.h"
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace paired_starts_test {

using testing::HasSubstr;

constexpr StartOutcome kRight = StartOutcome::kRight, kLate = StartOutcome::kLate,
                       kWrong = StartOutcome::kWrong, kWaiting = StartOutcome::kWaiting;

// Starts at every tenth frame; nullopt in place of the parallax: the truth is not known.
std::vector<StartRecord> Starts(const std::vector<StartOutcome>& outcomes,
                                std::optional<double> parallax_deg = 5) {
  std::vector<StartRecord> starts;
  for (const StartOutcome outcome : outcomes) {
    StartRecord start;
    start.frame = 10 * static_cast<int>(starts.size());
    start.outcome = outcome;
    start.greatest_parallax_deg = parallax_deg;
    if (outcome != kWaiting) start.map.emplace();
    starts.push_back(start);
  }
  return starts;
}

Plan PlanWithReference(const ScratchFolder& folder) {
  Plan plan = PlanOfStarts(folder);
  plan.experiment.reference = "one";
  return plan;
}

// Both variants have as many right starts, but not the same: what a table of counts cannot tell.
TEST(PairStarts, CountTheStartsThatOneOfTwoMakesRight) {
  const ScratchFolder folder;
  const Plan plan = PlanWithReference(folder);
  const auto pairs = PairStarts(plan,
                                {Starts({kRight, kRight, kWrong, kWaiting}),
                                 Starts({kRight, kWaiting, kRight, kLate}),
                                 Starts({kRight, kRight}),
                                 Starts({kWrong, kWrong})});
  ASSERT_EQ(pairs.size(), 6U) << "of each variant two sequences and both";
  EXPECT_EQ(pairs[2].right, 4) << "of the reference";
  EXPECT_EQ(pairs[2].right_alone + pairs[2].reference_alone, 0);
  const PairedStarts &a = pairs[3], &all = pairs[5];
  EXPECT_EQ(a.variant, 1U);
  EXPECT_EQ(a.sequence, 0U);
  EXPECT_EQ(a.starts, 4);
  EXPECT_EQ(a.possible, 4);
  EXPECT_EQ(a.right, 2);
  EXPECT_EQ(a.late, 1);
  EXPECT_EQ(a.waiting, 1);
  EXPECT_EQ(a.wrong, 0);
  EXPECT_EQ(a.right_alone, 1);
  EXPECT_EQ(a.reference_alone, 1);
  EXPECT_EQ(a.p, 1);
  EXPECT_EQ(a.gain, 0);
  EXPECT_FALSE(all.sequence);
  EXPECT_EQ(all.right_alone, 1);
  EXPECT_EQ(all.reference_alone, 3);
  EXPECT_EQ(all.wrong, 2);
  EXPECT_NEAR(all.p, 2 * 5 / 16.0, 1e-12);
  // Places of 0 and -100 points: Student's t of one degree of freedom, 12.706, times 50.
  EXPECT_EQ(all.places, 2);
  EXPECT_EQ(all.gain, -50);
  EXPECT_NEAR(*all.gain_high, -50 + 12.7062 * 50, 1e-2);
}

TEST(PairStarts, ImpossibleOnesCountOnlyWhereTheyAreWrong) {
  const ScratchFolder folder;
  const auto pairs = PairStarts(PlanWithReference(folder),
                                {Starts({kRight, kWaiting}, 1),
                                 Starts({kWaiting, kWrong}, 1),
                                 Starts({kWaiting}, std::nullopt),
                                 Starts({kRight}, std::nullopt)});
  ASSERT_EQ(pairs.size(), 6U);
  EXPECT_EQ(pairs[3].possible, 0);
  EXPECT_EQ(pairs[3].wrong, 1);
  EXPECT_EQ(pairs[3].waiting, 0);
  EXPECT_EQ(pairs[3].reference_alone, 0);
  EXPECT_FALSE(pairs[3].gain);
  EXPECT_EQ(pairs[4].possible, 1) << "not known to be impossible";
  EXPECT_EQ(pairs[4].right_alone, 1);
  EXPECT_EQ(pairs[4].gain, 100);
}

TEST(PairStarts, AVariantMayHaveAReferenceOfItsOwn) {
  const ScratchFolder folder;
  Plan plan = PlanWithReference(folder);
  plan.experiment.reference = "";
  plan.experiment.variants[0].reference = "two";
  const auto pairs = PairStarts(
      plan, {Starts({kRight}), Starts({kWaiting}), Starts({kRight}), Starts({kWaiting})});
  ASSERT_EQ(pairs.size(), 3U) << "the other one has none";
  EXPECT_EQ(pairs.back().variant, 0U);
  EXPECT_EQ(pairs.back().right_alone, 2);
  EXPECT_THAT(FormatPairs(plan, pairs), HasSubstr("| one / two | all 2 places | 2 / 2 |"));
  plan.experiment.variants[0].reference = "";
  EXPECT_TRUE(PairStarts(plan, {{}, {}, {}, {}}).empty());
  EXPECT_EQ(FormatPairs(plan, {}), "");
}

TEST(SignTest, IsExact) {
  EXPECT_EQ(SignTestP(0, 0), 1);
  EXPECT_EQ(SignTestP(3, 3), 1);
  EXPECT_NEAR(SignTestP(0, 6), 2.0 / 64, 1e-12);
  EXPECT_NEAR(SignTestP(6, 0), 2.0 / 64, 1e-12);
  EXPECT_NEAR(SignTestP(1, 9), 2 * 11.0 / 1024, 1e-12);
}

TEST(PairStarts, StandInTheTableThePageAndTheList) {
  const ScratchFolder folder;
  const Plan plan = PlanWithReference(folder);
  const StartsByJob starts = {
      Starts({kRight, kRight}), Starts({kRight, kWaiting}), Starts({kRight}), Starts({kWrong})};
  WriteResults(plan, LeaveStarts(plan, starts));
  EXPECT_THAT(Contents(folder / "out/table.md"),
              HasSubstr("| two | euroc/a | 1 / 2 | 0 | 0 | 1 | 0 | 1 | 1 | -50.0 |"));
  EXPECT_THAT(Contents(folder / "out/table.html"),
              HasSubstr("<td>all 2 places</td><td>1 / 3</td>"));
  std::map<std::string, double> over_all;
  for (const auto& figure : nlohmann::json::parse(Contents(folder / "out/results.json"))) {
    if (figure["sequence"] != "all_places" || figure["variant"] != "two") continue;
    EXPECT_TRUE(figure["seed"].is_null());
    over_all[figure["metric"]] = figure["value"];
  }
  EXPECT_EQ(over_all["right"], 1);
  EXPECT_EQ(over_all["possible_or_unknown"], 3);
  EXPECT_EQ(over_all["waiting"], 1);
  EXPECT_EQ(over_all["wrong"], 1);
  EXPECT_EQ(over_all["reference_right_alone"], 2);
}

}  // namespace paired_starts_test
}  // namespace plumbline
