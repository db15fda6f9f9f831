// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table_list.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

TEST(TableList, HasTheCellsOfTheTableAndWhatFailed) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  const auto table = MakeTable(plan, SomeResults(), MetricKind::kRepeatable);
  const auto json = nlohmann::json::parse(FormatTableList(plan, table, {}));
  EXPECT_EQ(json["centre"], "median");
  EXPECT_EQ(json["columns"][0]["metric"], "ate");
  EXPECT_EQ(json["columns"][0]["title"], "ate [mm]");
  ASSERT_EQ(json["rows"].size(), 4U);
  EXPECT_EQ(json["rows"][0]["sequence"], "euroc/a");
  EXPECT_EQ(json["rows"][0]["variant"], "one");
  EXPECT_EQ(json["rows"][0]["runs"], "2");
  EXPECT_EQ(json["rows"][0]["cells"][0], "4.50 (4.00-5.00)");
  EXPECT_EQ(json["rows"][1]["runs"], "1, 1 failed");
  ASSERT_EQ(json["failures"].size(), 1U);
  EXPECT_EQ(json["failures"][0], "failed: euroc/a, two, 1 run: ended by signal 11");
  EXPECT_TRUE(json["printed"].empty());
}

TEST(TableList, HasDashesByTheRuleOfTheSecondPaper) {
  const ScratchFolder folder;
  Plan plan = PlanOfTwo(folder);
  plan.experiment.tolerated_failures = 0;
  const auto table = MakeTable(plan, SomeResults(), MetricKind::kRepeatable);
  const auto json = nlohmann::json::parse(FormatTableList(plan, table, {}));
  EXPECT_EQ(json["centre"], "mean");
  EXPECT_EQ(json["rows"][1]["cells"][0], "-");
  EXPECT_EQ(json["rows"][0]["cells"][0], "4.50 (4.00-5.00)");
}

TEST(TableList, HasThePrintedFiguresBesideOurs) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  const auto table = MakeTable(plan, SomeResults(), MetricKind::kRepeatable);
  PaperComparison comparison;
  comparison.tables = {{"ate [mm]: P", "a note", "ate", {"one"}, {{"euroc/a", {"3"}, {"4"}, "2"}}}};
  const auto json = nlohmann::json::parse(FormatTableList(plan, table, comparison));
  EXPECT_EQ(json["printed"][0]["metric"], "ate");
  EXPECT_EQ(json["printed"][0]["header"],
            nlohmann::json::parse(R"(["sequence", "one, paper", "one, ours", "runs"])"));
  EXPECT_EQ(json["printed"][0]["rows"], nlohmann::json::parse(R"([["euroc/a", "3", "4", "2"]])"));
  EXPECT_TRUE(json["missing"].empty());
}

}  // namespace
}  // namespace plumbline
