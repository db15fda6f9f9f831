// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paper_comparison.h"

#include "lab/experiments/catalog.h"
#include "lab/experiments/results.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// rippl-table1 with fr1_xyz as it is, a part of fr1_floor, and a sequence of our own.
Plan PlanOfTable1(const ScratchFolder& folder) {
  for (const std::string name :
       {"rgbd_dataset_freiburg1_xyz", "rgbd_dataset_freiburg1_floor_first3"}) {
    std::string list, truth;
    for (int i = 0; i < 3; ++i) {
      list += fmt::format("{}.0 rgb/{}.png\n", i + 1, i);
      truth += fmt::format("{}.0 {} 0 0 0 0 0 1\n", i + 1, i);
      WriteImage(folder, fmt::format("data/tum/{}/rgb/{}.png", name, i));
    }
    folder.Write("data/tum/" + name + "/rgb.txt", list);
    folder.Write("data/tum/" + name + "/groundtruth.txt", truth);
  }
  WriteSequenceFolder(folder, "data/euroc/ours");
  Experiment experiment = FindExperiment("rippl-table1");
  std::erase_if(experiment.sequences,
                [](const SequenceChoice& c) { return c.pattern.starts_with("worlds/"); });
  PlanRequest request = RequestIn(folder);
  request.runs = 1;
  return MakePlan(experiment, request);
}

PaperComparison Compare(const Plan& plan) {
  std::vector<JobResult> results;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    results.push_back(Success(5.0 + static_cast<double>(i), std::to_string(i)));
    results.back().figures->values["rpe_pairs"] = 7;
  }
  return CompareWithPaper(plan, MakeTable(plan, results, MetricKind::kRepeatable));
}

TEST(PaperComparison, HasThePapersFiguresInOurUnitsBesideOurs) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTable1(folder);
  EXPECT_THAT(plan.missing,
              testing::Contains(HasSubstr("tum/rgbd_dataset_freiburg2_desk (fr2_desk; https://")));
  const PaperComparison comparison = Compare(plan);
  ASSERT_EQ(comparison.tables.size(), 2U);
  const ComparedTable& ate = comparison.tables[0];
  EXPECT_EQ(ate.title, "ate [mm]: Lee and Hwang, ICCV 2019, Table 1, page 7");
  ASSERT_EQ(ate.rows.size(), 9U);
  EXPECT_EQ(ate.rows[0].sequence, "fr1_xyz");
  EXPECT_THAT(ate.rows[0].printed, ElementsAre("10.178", "12.514"));
  EXPECT_THAT(ate.rows[0].ours, ElementsAre("5.00", "6.00"));
  EXPECT_EQ(ate.rows[1].sequence, "fr2_xyz");
  EXPECT_THAT(ate.rows[1].ours, ElementsAre("-", "-"));
  EXPECT_EQ(ate.rows[0].runs, "1");
  EXPECT_EQ(ate.rows[1].runs,
            "not there: `experiment rippl-table1 --full --only tum/rgbd_dataset_freiburg2_xyz`");
  EXPECT_EQ(ate.rows[2].sequence, "fr1_floor (a part: tum/rgbd_dataset_freiburg1_floor_first3)");
  EXPECT_THAT(ate.rows[5].printed, ElementsAre("36.836", "ambiguity"));
  EXPECT_EQ(ate.rows[8].sequence, "euroc/ours");
  EXPECT_THAT(ate.rows[8].printed, ElementsAre("", ""));
  EXPECT_THAT(comparison.tables[1].rows[0].printed, ElementsAre("16.275", "17.32"));
}

TEST(PaperComparison, IsWrittenAsMarkdownAndHtml) {
  const ScratchFolder folder;
  const PaperComparison comparison = Compare(PlanOfTable1(folder));
  const std::string markdown = FormatComparisonMarkdown(comparison);
  EXPECT_THAT(markdown, HasSubstr("| fr1_xyz | 10.178 | 5.00 | 12.514 | 6.00 | 1 |\n"));
  EXPECT_THAT(markdown, HasSubstr("| fr2_desk | 46.464 | - | 46.942 | - | not there: `"));
  const std::string html = FormatComparisonHtml(comparison);
  EXPECT_THAT(html, HasSubstr("<tr><th>fr1_xyz</th><td>10.178</td><td>5.00</td>"));
  EXPECT_THAT(html, HasSubstr("<th>proposed, paper</th><th>proposed, ours</th>"));
  PaperComparison words;
  words.statements = {{"e", "P", "page 1", "a < b"}};
  EXPECT_THAT(FormatComparisonHtml(words), HasSubstr("<li>P, page 1: a &lt; b</li>"));
  EXPECT_EQ(FormatComparisonMarkdown({}), "");
}

TEST(PaperComparison, TellsTheRunsOfEachVariantWhereTheyDiffer) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/ours");
  Experiment experiment = FindExperiment("rippl-table1");
  std::erase_if(experiment.sequences,
                [](const SequenceChoice& c) { return c.pattern.starts_with("worlds/"); });
  PlanRequest request = RequestIn(folder);
  request.runs = 2;
  const Plan plan = MakePlan(experiment, request);
  const auto table =
      MakeTable(plan,
                {Success(4, "a"), Success(4, "a"), Success(5, "b"), NoResult("ended by signal 11")},
                MetricKind::kRepeatable);
  EXPECT_EQ(CompareWithPaper(plan, table).tables[0].rows.back().runs, "1, 1 the same; 1, 1 failed");
}

TEST(PaperComparison, IsEmptyWhereNoPaperIsReproduced) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  const std::vector<JobResult> results(8, Success(4, "a"));
  const auto table = MakeTable(plan, results, MetricKind::kRepeatable);
  EXPECT_TRUE(CompareWithPaper(plan, table).tables.empty());
}

TEST(PaperComparison, OtherSystemsHaveTheirColumnOnly) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/V1_01_easy");
  Experiment experiment = FindExperiment("cutting-table2-3");
  std::erase_if(experiment.sequences,
                [](const SequenceChoice& c) { return c.pattern.starts_with("worlds/"); });
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  std::vector<JobResult> results(plan.jobs.size(), Success(1, "a"));
  for (JobResult& result : results) result.figures->values["rpe_causal_mean"] = 0.012;
  const std::string text = FormatComparisonMarkdown(
      CompareWithPaper(plan, MakeTable(plan, results, MetricKind::kRepeatable)));
  EXPECT_THAT(text, HasSubstr("| P, paper | P, ours | ORB2, paper | SVO2, paper |"));
  EXPECT_THAT(text, HasSubstr("| V1_01_easy | 0.044 | 0.01200 | 0.043 | 0.01200 |"));
  EXPECT_THAT(text, HasSubstr("| V1_01_easy blurred | 0.054 | 0.01200 |"));
  EXPECT_THAT(text, Not(HasSubstr("ORB2, ours")));
}

}  // namespace
}  // namespace plumbline
