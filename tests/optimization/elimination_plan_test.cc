// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/elimination_plan.h"

#include "tests/optimization/block_patterns.h"
#include <cmath>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ManyPatterns;
using testing::PathPattern;

TEST(EliminationPlan, EliminatesEveryRowOnce) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    std::vector<int> eliminated(pattern.size(), 0);
    const EliminationPlan plan = PlanElimination(pattern);
    for (const Front& front : plan.fronts) {
      ASSERT_GT(front.pivots, 0);
      ASSERT_GE(static_cast<int>(front.rows.size()), front.pivots);
      for (int k = 0; k < front.pivots; ++k) {
        ++eliminated[static_cast<std::size_t>(front.rows[static_cast<std::size_t>(k)])];
      }
    }
    EXPECT_EQ(eliminated, std::vector<int>(pattern.size(), 1));
  }
}

TEST(EliminationPlan, ParentsComeLaterAndHaveAllThatTheirChildrenChange) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    const EliminationPlan plan = PlanElimination(pattern);
    for (std::size_t f = 0; f < plan.fronts.size(); ++f) {
      const Front& front = plan.fronts[f];
      const bool changes = static_cast<int>(front.rows.size()) > front.pivots;
      ASSERT_EQ(front.parent >= 0, changes);
      if (!changes) continue;
      ASSERT_GT(front.parent, static_cast<int>(f));
      const std::vector<int>& above = plan.fronts[static_cast<std::size_t>(front.parent)].rows;
      const std::set<int> known(above.begin(), above.end());
      for (std::size_t k = static_cast<std::size_t>(front.pivots); k < front.rows.size(); ++k) {
        EXPECT_TRUE(known.contains(front.rows[k]));
      }
    }
  }
}

TEST(EliminationPlan, HasEachBlockInTheFrontThatEliminatesIt) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    std::set<std::pair<int, int>> covered;
    for (const Front& front : PlanElimination(pattern).fronts) {
      for (int k = 0; k < front.pivots; ++k) {
        for (const int row : front.rows) {
          const int pivot = front.rows[static_cast<std::size_t>(k)];
          covered.insert({std::max(row, pivot), std::min(row, pivot)});
        }
      }
    }
    for (std::size_t row = 0; row < pattern.size(); ++row) {
      for (const int column : pattern[row]) {
        EXPECT_TRUE(covered.contains({static_cast<int>(row), column}));
      }
    }
  }
}

TEST(EliminationPlan, IsEmptyWhenItIsStopped) {
  const BlockPattern pattern = PathPattern(20, 3, 1000);
  int questions = 0;
  EXPECT_FALSE(PlanElimination(pattern, [&] { return ++questions < 0; }).fronts.empty());
  EXPECT_GT(questions, 20) << "before every column";
  for (int until = 0; until < questions; ++until) {
    int asked = 0;
    const EliminationPlan plan = PlanElimination(pattern, [&] { return asked++ >= until; });
    EXPECT_TRUE(plan.fronts.empty()) << until;
    EXPECT_LE(asked, until + 2);
  }
}

TEST(EliminationPlan, CountsOneFrontAsFull) {
  EXPECT_NEAR(FullSize(PlanElimination(PathPattern(100, 100, 1000))), 100, 0.01);
  EXPECT_NEAR(FullSize(PlanInOneFront(100)), 100, 0.01);
  EXPECT_EQ(FullSize(PlanElimination({})), 0);
  EXPECT_EQ(FullSize(PlanInOneFront(0)), 0);
  EXPECT_TRUE(PlanInOneFront(0).fronts.empty());
  std::vector<int> rows(5);
  std::iota(rows.begin(), rows.end(), 0);
  EXPECT_EQ(PlanInOneFront(5).fronts.at(0).rows, rows);
}

// A path that never comes back can be eliminated from its ends without anything new.
TEST(EliminationPlan, LosesNoZerosOfAPath) {
  constexpr int kRows = 400, kReach = 10;
  double least = 0;
  for (int row = 0; row < kRows; ++row) {
    const double below = std::min(kReach, kRows - 1 - row);
    least += below * (below + 1) / 2;
  }
  const EliminationPlan plan = PlanElimination(PathPattern(kRows, kReach, 100000));
  EXPECT_GE(plan.multiplications, least);
  EXPECT_LE(plan.multiplications, 2.5 * least);
}

// In the order of time a row of the last round would reach back to the first: 800 rows, nearly all
// of them full.
TEST(EliminationPlan, TakesLittleForPathsThatComeBack) {
  const EliminationPlan plan = PlanElimination(PathPattern(800, 3, 200));
  EXPECT_LT(FullSize(plan), 250);
  EXPECT_GT(plan.fronts.size(), 10U);
}

TEST(EliminationPlan, DependsOnThePatternAlone) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    const EliminationPlan a = PlanElimination(pattern);
    const EliminationPlan b = PlanElimination(BlockPattern(pattern));
    ASSERT_EQ(a.fronts.size(), b.fronts.size());
    for (std::size_t f = 0; f < a.fronts.size(); ++f) {
      EXPECT_EQ(a.fronts[f].rows, b.fronts[f].rows);
      EXPECT_EQ(a.fronts[f].pivots, b.fronts[f].pivots);
      EXPECT_EQ(a.fronts[f].parent, b.fronts[f].parent);
    }
  }
}

}  // namespace
}  // namespace plumbline
