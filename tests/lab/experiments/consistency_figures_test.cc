// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/consistency_figures.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/consistency/consistent_run.h"
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ConsistencyFigures, AreSharesInPercent) {
  const ScratchFolder folder;
  WriteConsistentRun(folder);
  RunFigures figures;
  AddConsistencyFigures(folder / "s", folder / "run", figures);
  EXPECT_NEAR(figures.values.at("inside_point"), 90, 4);
  EXPECT_NEAR(figures.values.at("inside_line"), 90, 4);
  EXPECT_GE(figures.values.at("inside_most"), figures.values.at("inside_point"));
  EXPECT_LE(figures.values.at("inside_least"), figures.values.at("inside_line"));
  EXPECT_EQ(figures.reasons.at("inside_causal_5s"), "no such errors");
}

TEST(ConsistencyFigures, SayWhyThereAreNone) {
  const ScratchFolder folder;
  WriteConsistentRun(folder);
  folder.Write("run/map.plb", "no map");
  RunFigures figures;
  AddConsistencyFigures(folder / "s", folder / "run", figures);
  EXPECT_EQ(figures.reasons.at("inside_line"), "the run cannot be read");
  EXPECT_TRUE(AsksForConsistency(std::vector<std::string>{"ate", "inside_line"}));
  EXPECT_FALSE(AsksForConsistency(std::vector<std::string>{"ate"}));
}

}  // namespace
}  // namespace plumbline
