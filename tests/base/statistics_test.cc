// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/statistics.h"

#include <gtest/gtest.h>

namespace plumbline {

namespace {

TEST(UpperMedian, IsAValueOfTheListOrZero) {
  EXPECT_EQ(UpperMedian(std::vector<double>{}), 0);
  EXPECT_EQ(UpperMedian(std::vector<double>{3}), 3);
  EXPECT_EQ(UpperMedian(std::vector<double>{5, 1, 3}), 3);
  EXPECT_EQ(UpperMedian(std::vector<double>{4, 1, 3, 2}), 3);
}

TEST(Chi2Limit95, MatchesTheTablesAndContinuesSmoothly) {
  EXPECT_NEAR(Chi2Limit95(2), 5.991, 1e-3);
  EXPECT_NEAR(Chi2Limit95(4), 9.488, 1e-3);
  EXPECT_NEAR(Chi2Limit95(20), 31.410, 0.03);
  EXPECT_NEAR(Chi2Limit95(40), 55.758, 0.05);
}

// With two degrees of freedom, the share 1 - exp(-x / 2) lies below x.
TEST(Chi2, TheLimitsOfTwoDegreesOfFreedomAreThoseOfTheExponential) {
  EXPECT_NEAR(1 - std::exp(-0.5 * kChi2TwoDof95), 0.95, 1e-4);
  EXPECT_NEAR(1 - std::exp(-0.5 * kChi2TwoDof99), 0.99, 1e-4);
}

}  // namespace

}  // namespace plumbline
