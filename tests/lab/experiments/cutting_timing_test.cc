// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/cutting_timing.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(CuttingTiming, FiguresRepeatAndTimesStandApart) {
  const auto go_on = [](std::size_t, std::size_t) { return true; };
  const auto once = TimeCutting(2, go_on), twice = TimeCutting(2, go_on);
  ASSERT_TRUE(once && twice);
  ASSERT_EQ(once->figures.size(), 4U * 3U);
  ASSERT_EQ(once->times.size(), 4U * 3U);
  for (std::size_t i = 0; i < once->figures.size(); ++i) {
    EXPECT_EQ(once->figures[i].value, twice->figures[i].value);
    EXPECT_EQ(once->figures[i].metric, "mean_gain");
    EXPECT_GE(*once->figures[i].value, 0) << "cutting never takes information away";
    EXPECT_EQ(once->times[i].metric, "cut_time");
    EXPECT_GT(*once->times[i].value, 0);
  }
  EXPECT_FALSE(TimeCutting(1, [](auto, auto) { return false; }).has_value());
}

}  // namespace
}  // namespace plumbline
