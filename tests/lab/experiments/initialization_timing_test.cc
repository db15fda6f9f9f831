// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/initialization_timing.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(InitializationTiming, TheFactorizationFindsTheCentreAndTimesStandApart) {
  const auto go_on = [](std::size_t, std::size_t) { return true; };
  const auto timing = TimeInitialization(3, go_on), again = TimeInitialization(3, go_on);
  ASSERT_TRUE(timing && again);
  ASSERT_EQ(timing->figures.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(timing->figures[i].value.has_value());
    EXPECT_LT(*timing->figures[i].value, 1) << "degrees";
    EXPECT_EQ(timing->figures[i].value, again->figures[i].value);
  }
  ASSERT_EQ(timing->times.size(), 9U);
  for (const FigureRow& row : timing->times) EXPECT_GT(*row.value, 0) << row.metric;
  EXPECT_FALSE(TimeInitialization(1, [](auto, auto) { return false; }).has_value());
}

}  // namespace
}  // namespace plumbline
