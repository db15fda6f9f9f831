// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paired_ratios.h"

#include "plumbline/base/random.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using testing::HasSubstr;

// Sequences a and b, variants one and two, two runs of each: a/one/1, a/one/2, a/two/1, ...
Plan PlanWithReference(const ScratchFolder& folder) {
  Plan plan = PlanOfTwo(folder);
  plan.experiment.reference = "one";
  return plan;
}

const PairedRatio& Find(const std::vector<PairedRatio>& ratios,
                        std::optional<std::size_t> sequence,
                        std::size_t variant) {
  const auto found = std::find_if(ratios.begin(), ratios.end(), [&](const PairedRatio& r) {
    return r.sequence == sequence && r.variant == variant;
  });
  EXPECT_NE(found, ratios.end());
  return *found;
}

TEST(PairedRatios, AreGeometricMeansOverTheRuns) {
  const ScratchFolder folder;
  const auto ratios = PairedRatios(PlanWithReference(folder),
                                   {Success(2, "a"),
                                    Success(4, "b"),
                                    Success(4, "c"),
                                    Success(4, "d"),
                                    Success(1, "e"),
                                    Success(1, "f"),
                                    Success(8, "g"),
                                    Success(2, "h")});
  const PairedRatio& a = Find(ratios, 0, 1);
  EXPECT_EQ(a.pairs, 2);
  EXPECT_NEAR(a.ratio, std::sqrt(2.0), 1e-12);  // of 2 and 1
  // Two logarithms, log 2 and 0: Student's t with one degree of freedom, 12.706, times log(2) / 2.
  ASSERT_TRUE(a.low && a.high);
  EXPECT_NEAR(std::log(*a.high / a.ratio), 12.7062 * 0.5 * std::log(2.0), 1e-3);
  EXPECT_NEAR(*a.low * *a.high, a.ratio * a.ratio, 1e-9);
  EXPECT_NEAR(Find(ratios, 1, 1).ratio, 4, 1e-12);  // of 8 and 2
  const PairedRatio& all = Find(ratios, std::nullopt, 1);
  EXPECT_NEAR(all.ratio, std::pow(2.0, 1.25), 1e-12);
  EXPECT_EQ(all.pairs, 4);
  EXPECT_EQ(all.places, 2);
  EXPECT_LT(all.low, all.ratio);
  EXPECT_GT(all.high, all.ratio);
  EXPECT_NEAR(Find(ratios, std::nullopt, 0).ratio, 1, 1e-12);  // the reference against itself
}

// The mean of many draws from a normal distribution is known; so is its interval.
TEST(PairedRatios, IntervalsHaveTheWidthOfTheMeansSpread) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.reference = "one";
  experiment.runs = 100;
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  Rng rng(1);
  std::vector<JobResult> results;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const double ate = plan.jobs[i].variant == 0 ? 1 : std::exp(rng.Normal(0.5));
    results.push_back(Success(ate, std::to_string(i)));
  }
  const auto ratios = PairedRatios(plan, results);
  const PairedRatio& r = Find(ratios, 0, 1);
  const double half_width = 0.5 * std::log(*r.high / *r.low);
  EXPECT_NEAR(half_width, 1.96 * 0.5 / std::sqrt(100.0), 0.02);
}

TEST(PairedRatios, LeaveOutWhatCannotBeComparedAndCountWhoLosesAlone) {
  const ScratchFolder folder;
  JobResult lost = Success(3, "c", 60);
  lost.figures->values["lost"] = 4;
  const auto ratios = PairedRatios(PlanWithReference(folder),
                                   {Success(2, "a"),
                                    Success(2, "b"),
                                    lost,
                                    Success(1, "d"),
                                    Success(2, "e"),
                                    Success(2, "e"),
                                    NoResult("crashed"),
                                    Success(1, "f")});
  const PairedRatio& a = Find(ratios, 0, 1);
  EXPECT_EQ(a.pairs, 1);
  EXPECT_EQ(a.left_out, 1);
  EXPECT_EQ(a.lost_alone, 1);
  EXPECT_NEAR(a.ratio, 0.5, 1e-12);
  EXPECT_EQ(Find(ratios, 1, 1).lost_alone, 1);
  EXPECT_EQ(Find(ratios, 0, 0).lost_alone, 0);
}

TEST(PairedRatios, SamePairsCountOnce) {
  const ScratchFolder folder;
  const auto ratios = PairedRatios(PlanWithReference(folder),
                                   {Success(2, "a"),
                                    Success(2, "a"),
                                    Success(3, "b"),
                                    Success(3, "b"),
                                    NoResult("x"),
                                    NoResult("x"),
                                    NoResult("x"),
                                    NoResult("x")});
  EXPECT_EQ(Find(ratios, 0, 1).pairs, 1);
  EXPECT_EQ(RatioText(Find(ratios, 0, 1)), "1.500");
}

TEST(PairedRatios, SequencesOfOnePlaceCountAsOne) {
  EXPECT_EQ(PlaceOf("worlds/vicon_easy@blurred"), PlaceOf("worlds/vicon_difficult"));
  EXPECT_EQ(PlaceOf("euroc/V1_01_easy"), PlaceOf("euroc/V1_03_difficult@blurred"));
  EXPECT_NE(PlaceOf("euroc/V1_01_easy"), PlaceOf("euroc/V2_01_easy"));
  EXPECT_EQ(PlaceOf("worlds/lowtexture@blurred"), "worlds/lowtexture");
  EXPECT_EQ(PlaceOf("kitti/06_first51"), PlaceOf("kitti/06"));
  EXPECT_NE(PlaceOf("kitti/06"), PlaceOf("kitti/07"));
  const ScratchFolder folder;
  Plan plan = PlanWithReference(folder);
  plan.sequences[0].name = "worlds/vicon_easy";
  plan.sequences[1].name = "worlds/vicon_medium";
  const auto ratios = PairedRatios(plan,
                                   {Success(1, "a"),
                                    Success(1, "b"),
                                    Success(2, "c"),
                                    Success(2, "d"),
                                    Success(1, "e"),
                                    Success(1, "f"),
                                    Success(8, "g"),
                                    Success(8, "h")});
  const PairedRatio& all = Find(ratios, std::nullopt, 1);
  EXPECT_EQ(all.places, 1);
  EXPECT_NEAR(all.ratio, 4, 1e-12);  // of 2 and 8
  EXPECT_FALSE(all.low.has_value());
  EXPECT_EQ(VerdictText(all), "-");
}

// The interval covers the true mean as often as it says, also of five values, of which a percentile
// bootstrap covers 85 of 100.
TEST(PairedRatios, IntervalsOfFewValuesCoverTheTruth) {
  Rng rng(3);
  int covered = 0;
  constexpr int kTrials = 2000;
  for (int i = 0; i < kTrials; ++i) {
    std::vector<double> values;
    for (int k = 0; k < 5; ++k) values.push_back(rng.Normal(1));
    double mean = 0;
    for (const double value : values) mean += value / 5;
    covered += std::abs(mean) <= HalfWidthOfMean(values).value();
  }
  EXPECT_NEAR(covered, 0.95 * kTrials, 30);
}

TEST(PairedRatios, StartsArePairedByTheirFirstFrame) {
  const ScratchFolder folder;
  Plan plan = PlanWithReference(folder);
  plan.experiment.ratios = {"rotation_error"};
  const auto start = [](int frame, double error) {
    StartRecord record;
    record.frame = frame;
    record.outcome = StartOutcome::kRight;
    record.map.emplace();
    record.map->errors.rotation_deg = error;
    return record;
  };
  StartRecord waiting;
  waiting.frame = 20;
  // The second variant starts later and looks exact: its median is that of other starts.
  StartsByJob starts(plan.jobs.size());
  starts[0] = {start(0, 1), start(10, 2), start(20, 50)};
  starts[2] = {start(0, 2), start(10, 4), waiting};
  std::vector<JobResult> results(plan.jobs.size(), Success(1, "a"));
  const auto ratios = PairedRatios(plan, results, starts);
  const PairedRatio& a = Find(ratios, 0, 1);
  EXPECT_EQ(a.pairs, 2);
  EXPECT_NEAR(a.ratio, 2, 1e-12);
}

// Errors of maps beyond the limits, or of windows that begin elsewhere, say nothing about each
// other.
TEST(PairedRatios, OfStartsAreThoseThatBothMadeRightFromOneReference) {
  const ScratchFolder folder;
  Plan plan = PlanWithReference(folder);
  plan.experiment.ratios = {"direction_error", "map_parallax"};
  const auto start = [](int frame, double error, StartOutcome outcome, int reference) {
    StartRecord record;
    record.frame = frame;
    record.outcome = outcome;
    record.map.emplace();
    record.map->reference = reference;
    record.map->parallax_deg = 3;
    record.map->errors.direction_deg = error;
    return record;
  };
  constexpr StartOutcome kRight = StartOutcome::kRight, kWrong = StartOutcome::kWrong;
  StartsByJob starts(plan.jobs.size());
  starts[0] = {start(0, 1, kRight, 0), start(10, 9, kWrong, 10), start(20, 1, kRight, 20)};
  starts[2] = {start(0, 3, kRight, 0), start(10, 1, kRight, 10), start(20, 1, kRight, 21)};
  const std::vector<JobResult> results(plan.jobs.size(), Success(1, "a"));
  const auto ratios = PairedRatios(plan, results, starts);
  const PairedRatio& a = Find(ratios, 0, 1);
  EXPECT_EQ(a.metric, "direction_error");
  EXPECT_EQ(a.pairs, 1);
  EXPECT_EQ(a.left_out, 2);
  EXPECT_NEAR(a.ratio, 3, 1e-12);
  EXPECT_NEAR(ratios.back().ratio, 1, 1e-12) << "of the parallax";
}

TEST(PairedRatios, AVariantMayHaveAReferenceOfItsOwn) {
  const ScratchFolder folder;
  Plan plan = PlanWithReference(folder);
  plan.experiment.variants[0].reference = "two";
  std::vector<JobResult> results;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    results.push_back(Success(plan.jobs[i].variant == 0 ? 6 : 2, std::to_string(i)));
  }
  const auto ratios = PairedRatios(plan, results);
  EXPECT_NEAR(Find(ratios, std::nullopt, 0).ratio, 3, 1e-12);
  EXPECT_NEAR(Find(ratios, std::nullopt, 1).ratio, 1.0 / 3, 1e-12);
  EXPECT_THAT(FormatRatios(plan, ratios), HasSubstr("| one / two | **all 2 places** |"));
  const auto list = nlohmann::json::parse(FormatRatioList(plan, ratios));
  EXPECT_EQ(list.front()["reference"], "two");
  EXPECT_EQ(list.back()["reference"], "one");
}

TEST(PairedRatios, TellWhatTheyExcludeAndWhatChanceWouldGive) {
  PairedRatio ratio;
  ratio.pairs = 3;
  ratio.ratio = 1;
  ratio.low = 0.9;
  ratio.high = 1.1;
  EXPECT_EQ(VerdictText(ratio), "not told apart; below 0.90 and above 1.10 excluded");
  ratio.high = 0.98;
  EXPECT_EQ(VerdictText(ratio), "better");
  const ScratchFolder folder;
  ratio.variant = 1;
  EXPECT_EQ(ChanceText(PlanWithReference(folder), {ratio, ratio}),
            "Of 2 comparisons over all places, 0.1 would seem certain by chance alone.");
}

TEST(PairedRatios, AreThereForEveryErrorThatTheExperimentNames) {
  const ScratchFolder folder;
  Plan plan = PlanWithReference(folder);
  plan.experiment.ratios = {"ate", "rpe_mean"};
  std::vector<JobResult> results(plan.jobs.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool reference =
        plan.experiment.variants[plan.jobs[i].variant].name == plan.experiment.reference;
    RunFigures figures;
    figures.trajectory = std::to_string(i);
    figures.values = {{"ate", reference ? 2.0 : 3.0},
                      {"rpe_mean", reference ? 4.0 : 1.0},
                      {"coverage", 100.0},
                      {"lost", 0.0}};
    results[i].figures = figures;
  }
  const auto ratios = PairedRatios(plan, results);
  ASSERT_EQ(ByMetric(ratios).size(), 2U);
  const auto list = nlohmann::json::parse(FormatRatioList(plan, ratios));
  double ate = 0, rpe = 0;
  for (const auto& entry : list) {
    if (!entry["sequence"].is_null() || entry["variant"] == plan.experiment.reference) continue;
    (entry["metric"] == "ate" ? ate : rpe) = entry["ratio"];
  }
  EXPECT_EQ(ate, 1.5);
  EXPECT_EQ(rpe, 0.25);
  const std::string text = FormatRatios(plan, ratios);
  EXPECT_THAT(text, HasSubstr("## ATE against one"));
  EXPECT_THAT(text, HasSubstr("## rpe_mean against one"));
}

TEST(PairedRatios, AreThereOnlyWithAReference) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  const std::vector<JobResult> results(plan.jobs.size(), Success(1, "a"));
  EXPECT_TRUE(PairedRatios(plan, results).empty());
  EXPECT_EQ(FormatRatios(plan, {}), "");
  const ScratchFolder other;
  const Plan with = PlanWithReference(other);
  EXPECT_THAT(FormatRatios(with, PairedRatios(with, results)), HasSubstr("## ATE against one"));
}

}  // namespace
}  // namespace plumbline
