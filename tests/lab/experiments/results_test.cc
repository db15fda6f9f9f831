// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/results.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace results_test {

using testing::ElementsAre;

std::vector<std::string> NamesOf(const std::vector<const Metric*>& metrics) {
  std::vector<std::string> names;
  for (const Metric* metric : metrics) names.emplace_back(metric->name);
  return names;
}

TEST(Results, CoverageStandsBesideEveryAte) {
  Experiment experiment = TwoVariants();
  EXPECT_THAT(NamesOf(MetricsOf(experiment, MetricKind::kRepeatable)),
              ElementsAre("ate", "coverage", "lost"));
  EXPECT_THAT(NamesOf(MetricsOf(experiment, MetricKind::kTiming)), ElementsAre("fps"));
  experiment.metrics = {"lost"};
  experiment.plots = {"ate_causal", "memory_mb"};
  EXPECT_THAT(NamesOf(MetricsOf(experiment, MetricKind::kRepeatable)),
              ElementsAre("lost", "ate_causal", "coverage"));
  EXPECT_THAT(NamesOf(MetricsOf(experiment, MetricKind::kTiming)), ElementsAre("memory_mb"));
}

TEST(Results, AreAListOfFiguresWithUnits) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  const auto rows = CollectResults(plan, SomeResults(), MetricKind::kRepeatable);
  const auto json = nlohmann::json::parse(FormatResults("pair", rows));
  ASSERT_EQ(json.size(), 8U * 3U);
  EXPECT_EQ(json[0],
            nlohmann::json::parse(R"({"experiment": "pair", "sequence": "euroc/a", "variant": "one",
                                      "seed": 1, "metric": "ate", "value": 4.0, "unit": "mm"})"));
  EXPECT_EQ(json[1]["metric"], "coverage");
  EXPECT_EQ(json[1]["unit"], "%");
  EXPECT_EQ(json[3]["seed"], 2);
  for (int i = 6; i < 9; ++i) {
    EXPECT_TRUE(json[i]["value"].is_null());
    EXPECT_EQ(json[i]["reason"], "ended by signal 11");
  }
  std::set<std::string> metrics;
  for (const auto& row : json) metrics.insert(row["metric"]);
  EXPECT_THAT(metrics, ElementsAre("ate", "coverage", "lost"));
}

TEST(Results, AMetricWithoutValueSaysWhy) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  std::vector<JobResult> results = SomeResults();
  results[0].figures->values.erase("ate");
  results[0].figures->reasons["ate"] = "no frame has a pose";
  const auto json = nlohmann::json::parse(
      FormatResults("pair", CollectResults(plan, results, MetricKind::kRepeatable)));
  EXPECT_TRUE(json[0]["value"].is_null());
  EXPECT_EQ(json[0]["reason"], "no frame has a pose");
  EXPECT_EQ(json[1]["value"], 100.0);
}

}  // namespace results_test
}  // namespace plumbline
