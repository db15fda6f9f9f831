// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/start_pools.h"

#include "lab/experiments/write_results.h"

#include "tests/lab/experiments/start_fixtures.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(StartPools, TakeTheStartsOfTheirSequencesTogether) {
  const ScratchFolder folder;
  const Plan plan = PlanOfStarts(folder);
  const auto results = LeaveStarts(plan, StartsOfTwo());
  const StartsByJob starts = ReadStartsByJob(plan, results);
  ASSERT_EQ(starts.size(), 4U);
  EXPECT_EQ(starts[2].size(), 2U);
  EXPECT_EQ(StartsOfPool(plan, starts, plan.experiment.pools[0], 0).size(), 4U);
  EXPECT_EQ(StartsOfPool(plan, starts, plan.experiment.pools[1], 0).size(), 0U);

  const PooledResults pooled = WithPools(plan, results, starts);
  ASSERT_EQ(pooled.plan.jobs.size(), 6U) << "a row for each variant; nothing of the other pool";
  EXPECT_EQ(pooled.plan.sequences.back().name, "real");
  EXPECT_EQ(pooled.plan.NameOf(pooled.plan.jobs[4]), "real/one/1");
  EXPECT_EQ(pooled.results[4].figures->values.at("success"), 75);
  EXPECT_EQ(pooled.results[4].figures->values.at("rotation_error"), 0.1);
  EXPECT_EQ(pooled.results[4].figures->values.at("rotation_error_p95"), 0.3);
  EXPECT_EQ(pooled.results[5].figures->values.at("success"), 50);
}

TEST(StartPools, AFailureOfASequenceIsOneOfThePool) {
  const ScratchFolder folder;
  const Plan plan = PlanOfStarts(folder);
  auto results = LeaveStarts(plan, StartsOfTwo());
  results[2] = NoResult("ended by signal 11");
  const PooledResults pooled = WithPools(plan, results, ReadStartsByJob(plan, results));
  EXPECT_FALSE(pooled.results[4].figures);
  EXPECT_EQ(pooled.results[4].reason, "a sequence of the pool failed");
  EXPECT_TRUE(pooled.results[5].figures);
}

TEST(StartPools, AllStartsAreOneTable) {
  const ScratchFolder folder;
  const std::string text = FormatStartsByJob(PlanOfStarts(folder), StartsOfTwo());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 7);
  EXPECT_THAT(text, HasSubstr("sequence,variant,seed,frame,outcome,"));
  EXPECT_THAT(text, HasSubstr("\neuroc/b,one,1,0,waiting,ambiguous,"));
}

TEST(StartPools, AreRowsOfTheTableAndItsFigures) {
  const ScratchFolder folder;
  const Plan plan = PlanOfStarts(folder);
  WriteResults(plan, LeaveStarts(plan, StartsOfTwo()));
  EXPECT_THAT(Contents(folder / "out/table.md"),
              HasSubstr("| real | one | 1 | 4 | **75.0** | 0 |"));
  EXPECT_THAT(Contents(folder / "out/results.json"), HasSubstr(R"("sequence":"real")"));
  EXPECT_THAT(Contents(folder / "out/results.json"), Not(HasSubstr("add_ms")));
  EXPECT_THAT(Contents(folder / "out/timing.json"), HasSubstr("add_ms"));
  EXPECT_THAT(Contents(folder / "out/starts.csv"), HasSubstr("euroc/a,two,1,"));
  EXPECT_THAT(Contents(folder / "out/plots/start_time.svg"), HasSubstr("<svg"));
}

}  // namespace
}  // namespace plumbline
