// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/median.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(UpperMedian, IsAValueOfTheListOrZero) {
  EXPECT_EQ(UpperMedian(std::vector<double>{}), 0);
  EXPECT_EQ(UpperMedian(std::vector<double>{3}), 3);
  EXPECT_EQ(UpperMedian(std::vector<double>{5, 1, 3}), 3);
  EXPECT_EQ(UpperMedian(std::vector<double>{4, 1, 3, 2}), 3);
}

}  // namespace
}  // namespace plumbline
