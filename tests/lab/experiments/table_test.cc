// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// Runs of a/one, a/two, b/one, b/two, two of each.
ResultTable TableOf(const Plan& plan, const std::vector<JobResult>& results) {
  return MakeTable(plan, results, MetricKind::kRepeatable);
}

std::string Ate(const ResultTable& table, std::size_t row) {
  return CellText(table.rows[row], table.rows[row].cells[0], *table.columns[0]);
}

const std::vector<JobResult>& GoodRuns() {
  static const std::vector<JobResult> results = {Success(4, "a"),
                                                 Success(5, "b"),
                                                 Success(3, "c"),
                                                 Success(3.5, "d"),
                                                 Success(7, "e"),
                                                 Success(7, "e"),
                                                 Success(9, "f"),
                                                 Success(9, "f")};
  return results;
}

TEST(ResultTable, HasMedianAndRangeOfTheRuns) {
  EXPECT_FALSE(SpreadOf({}).has_value());
  const auto spread = SpreadOf({5, 1, 9, 2});
  EXPECT_DOUBLE_EQ(spread->centre, 3.5);
  EXPECT_DOUBLE_EQ(spread->min, 1);
  EXPECT_DOUBLE_EQ(spread->max, 9);
  EXPECT_DOUBLE_EQ(SpreadOf({3, 1, 2})->centre, 2);
  const ScratchFolder folder;
  const ResultTable table = TableOf(PlanOfTwo(folder), GoodRuns());
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(Ate(table, 0), "4.50 (4.00-5.00)");
  EXPECT_EQ(Ate(table, 2), "7.00");
}

TEST(ResultTable, HasMeansAndNothingOfVariantsThatFailOften) {
  EXPECT_DOUBLE_EQ(SpreadOf({5, 1, 9, 2}, Centre::kMean)->centre, 4.25);
  const ScratchFolder folder;
  Plan plan = PlanOfTwo(folder);
  plan.experiment.tolerated_failures = 1;
  std::vector<JobResult> results = GoodRuns();
  results[0] = Success(4, "a", 98.9);  // a/one: one run lost the camera
  results[2] = Success(3, "c", 98.9);  // a/two: one lost, one without a result
  results[3] = NoResult("hangs");
  results[5] = Success(8, "g");  // b/one: 7 and 8
  const ResultTable table = TableOf(plan, results);
  EXPECT_EQ(Ate(table, 0), "5.00");
  EXPECT_EQ(RunsText(table.rows[0]), "1, 1 failed");
  EXPECT_EQ(Ate(table, 1), "-");
  EXPECT_EQ(RunsText(table.rows[1]), "2 failed");
  EXPECT_EQ(Ate(table, 2), "7.50 (7.00-8.00)");
  EXPECT_THAT(FormatMarkdown(plan, table), HasSubstr("Mean (range) over the runs"));
  plan.experiment.tolerated_failures.reset();
  EXPECT_EQ(Ate(TableOf(plan, results), 1), "3.00");
}

TEST(ResultTable, RunsWithTheSameTrajectoryCountOnce) {
  const ScratchFolder folder;
  std::vector<JobResult> results = GoodRuns();
  results[1] = Success(8, "a");  // as only a test can make it
  const ResultTable table = TableOf(PlanOfTwo(folder), results);
  EXPECT_EQ(Ate(table, 0), "4.00");
  EXPECT_EQ(RunsText(table.rows[0]), "1, 1 the same");
  EXPECT_EQ(RunsText(table.rows[1]), "2");
  const ResultTable timing = MakeTable(PlanOfTwo(folder), results, MetricKind::kTiming);
  EXPECT_EQ(timing.columns[0]->name, "fps");
}

TEST(ResultTable, ShowsFailuresForWhatTheyAre) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  std::vector<JobResult> results = GoodRuns();
  results[1] = NoResult("hangs");
  results[2] = NoResult("breaks | here");
  results[3] = NoResult("breaks | here");
  results[5] = Success(8, "another");
  results[5].figures->values.erase("ate");
  results[6].figures->values.erase("ate");
  results[7].figures->values.erase("ate");
  const ResultTable table = TableOf(plan, results);
  EXPECT_EQ(Ate(table, 0), "4.00");
  EXPECT_EQ(RunsText(table.rows[0]), "1, 1 failed");
  EXPECT_EQ(Ate(table, 1), "-");
  EXPECT_EQ(Ate(table, 2), "7.00, 1 without");
  EXPECT_EQ(Ate(table, 3), "-");
  EXPECT_EQ(RunsText(table.rows[1]), "2 failed");
  const std::string text = FormatMarkdown(plan, table);
  EXPECT_THAT(text, HasSubstr("- failed: euroc/a, one, 1 run: hangs\n"));
  EXPECT_THAT(text, HasSubstr("- failed: euroc/a, two, 2 runs: breaks | here\n"));
}

TEST(ResultTable, MarksTheBestOfEachSequence) {
  const ScratchFolder folder;
  const ResultTable table = TableOf(PlanOfTwo(folder), GoodRuns());
  EXPECT_FALSE(table.rows[0].cells[0].best);
  EXPECT_TRUE(table.rows[1].cells[0].best);
  EXPECT_TRUE(table.rows[2].cells[0].best);
  EXPECT_FALSE(table.rows[3].cells[0].best);
  for (const TableRow& row : table.rows) EXPECT_FALSE(row.cells[1].best) << "all cover the same";
}

TEST(ResultTable, ASmallErrorOverHalfTheFramesIsNotTheBest) {
  const ScratchFolder folder;
  std::vector<JobResult> results = GoodRuns();
  results[2] = Success(3, "c", 50);
  results[3] = Success(3.5, "d", 50);
  results[5] = NoResult("hangs");  // of b/one, which is the better one
  const ResultTable table = TableOf(PlanOfTwo(folder), results);
  EXPECT_TRUE(table.rows[0].cells[0].best);
  EXPECT_FALSE(table.rows[1].cells[0].best);
  EXPECT_FALSE(table.rows[2].cells[0].best);
  EXPECT_TRUE(table.rows[3].cells[0].best);
}

TEST(ResultTable, IsWrittenAsMarkdown) {
  const ScratchFolder folder;
  Plan plan = PlanOfTwo(folder);
  plan.missing = {"icl/*"};
  const std::string text = FormatMarkdown(plan, TableOf(plan, GoodRuns()));
  EXPECT_THAT(text, HasSubstr("# pair\n\none thing and the other. Median (range)"));
  EXPECT_THAT(text,
              HasSubstr("| sequence | variant | runs | ate [mm] | coverage [%] | lost [frames] |\n"
                        "|---|---|---|---|---|---|\n"
                        "| euroc/a | one | 2 | 4.50 (4.00-5.00) | 100.0 | 0 |\n"
                        "| euroc/a | two | 2 | **3.25 (3.00-3.50)** | 100.0 | 0 |\n"));
  EXPECT_THAT(text, HasSubstr("- not there: no sequence icl/*\n"));
  EXPECT_THAT(text, HasSubstr("- ate: position error"));
}

}  // namespace
}  // namespace plumbline
