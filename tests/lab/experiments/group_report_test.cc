// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/group_report.h"

#include "lab/experiments/computed.h"
#include "lab/experiments/write_results.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(GroupReport, JoinsItsPartsAndNamesWhatIsMissing) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  PlanRequest request = RequestIn(folder);
  request.out = folder / "out/pair";
  Plan plan = MakePlan(TwoVariants(), request);
  plan.missing = {"icl/*"};
  std::vector<JobResult> results(4, Success(4, "a"));
  results[1] = NoResult("<crashed>");
  WriteResults(plan, results);
  GroupPart broken;
  broken.name = "other";
  broken.trouble = "no sequence found";
  WriteGroupReport(folder / "out", "both", "this and that", {SummarizePart(plan, results), broken});
  const auto joined = nlohmann::json::parse(Contents(folder / "out/results.json"));
  const auto single = nlohmann::json::parse(Contents(folder / "out/pair/results.json"));
  ASSERT_EQ(joined.size(), single.size() + 1);
  EXPECT_EQ(joined[0], single[0]);
  EXPECT_EQ(joined.back()["experiment"], "other");
  EXPECT_EQ(joined.back()["reason"], "no sequence found");
  EXPECT_TRUE(joined.back()["sequence"].is_null());
  EXPECT_GT(nlohmann::json::parse(Contents(folder / "out/timing.json")).size(), 0U);
  const std::string page = Contents(folder / "out/table.html");
  for (const char* part : {"<a href=\"pair/table.html\">pair</a>",
                           "4 runs, 1 failed",
                           "not run: no sequence found",
                           "<li>pair: failed: euroc/a, one, run 2: &lt;crashed&gt;</li>",
                           "<li>pair: no sequence icl/*</li>"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_THAT(Contents(folder / "out/table.md"), HasSubstr("| pair | 4 runs, 1 failed |"));
}

TEST(GroupReport, AFailedComputationIsAPartThatWasNotRun) {
  const ScratchFolder folder;
  const Plan plan =
      MakePlan(*FindComputedExperiment("cutting-testbed"), folder / "out", 1, "program");
  folder.Write("out/results.json", "[\n{\"experiment\": \"of an earlier call\"}\n]\n");
  const GroupPart part = SummarizePart(plan, {NoResult("ended by signal 9 (Killed)")});
  EXPECT_EQ(part.trouble, "ended by signal 9 (Killed)");
  EXPECT_EQ(part.failed, 1U);
  EXPECT_THAT(part.failures, ElementsAre("ended by signal 9 (Killed)"));
}

}  // namespace
}  // namespace plumbline
