// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/reading_time.h"

#include <chrono>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using std::chrono::milliseconds;

TEST(ReadingTime, IsAQuarterMoreThanTheLongestOfTheLastSixteen) {
  ReadingTime time;
  EXPECT_EQ(time.Enough(), milliseconds(0));
  time.Add(milliseconds(40));
  EXPECT_EQ(time.Enough(), milliseconds(50));
  for (int i = 0; i < 15; ++i) time.Add(milliseconds(8));
  EXPECT_EQ(time.Enough(), milliseconds(50));
  time.Add(milliseconds(4));
  EXPECT_EQ(time.Enough(), milliseconds(10)) << "the slow one is forgotten";
}

}  // namespace
}  // namespace plumbline
