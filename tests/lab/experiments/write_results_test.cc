// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/write_results.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace write_results_test {

using testing::HasSubstr;
using testing::Not;

TEST(WriteResults, FilesAreAllThereAndTimesAreApart) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  folder.Write("out/plots/of_before.svg", "");
  WriteResults(plan, SomeResults());
  for (const char* name : {"results.json",
                           "table.json",
                           "timing.json",
                           "timing_table.json",
                           "table.md",
                           "timing.md",
                           "table.html",
                           "plots/ate.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out/plots/of_before.svg"));
  for (const char* name : {"out/results.json", "out/table.json", "out/table.md"}) {
    EXPECT_THAT(Contents(folder / name), Not(HasSubstr("fps"))) << name;
  }
  EXPECT_THAT(Contents(folder / "out/timing.json"), HasSubstr("fps"));
  EXPECT_THAT(Contents(folder / "out/timing.md"), HasSubstr("fps"));
}

TEST(WriteResults, ForTheSameRunsHaveTheSameBytesWhateverTheTimes) {
  const ScratchFolder first, second;
  std::vector<JobResult> results = SomeResults();
  WriteResults(PlanOfTwo(first), results);
  for (JobResult& result : results) {
    if (result.figures) result.figures->values["fps"] = 31;
  }
  WriteResults(PlanOfTwo(second), results);
  for (const char* name :
       {"out/results.json", "out/table.json", "out/table.md", "out/plots/ate.svg"}) {
    EXPECT_EQ(Contents(first / name), Contents(second / name)) << name;
    EXPECT_GT(Contents(first / name).size(), 100U) << name;
  }
  EXPECT_NE(Contents(first / "out/timing.json"), Contents(second / "out/timing.json"));
}

}  // namespace write_results_test
}  // namespace plumbline
