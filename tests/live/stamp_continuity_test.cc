// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/live/stamp_continuity.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(StampContinuity, LeavesStampsThatIncrease) {
  StampContinuity continuity;
  for (const std::int64_t stamp : {5, 6, 100, 1'000'000'000}) {
    const auto next = continuity.Next(stamp);
    EXPECT_EQ(next.stamp_ns, stamp);
    EXPECT_FALSE(next.jumped_back_ns);
  }
}

TEST(StampContinuity, GoesOnBehindAJumpBack) {
  StampContinuity continuity;
  continuity.Next(1000);
  continuity.Next(1050);
  const auto jump = continuity.Next(200);
  EXPECT_EQ(jump.stamp_ns, 1100);  // one interval on
  EXPECT_EQ(jump.jumped_back_ns, 850);
  const auto after = continuity.Next(260);
  EXPECT_EQ(after.stamp_ns, 1160);  // 60 on, as by the source
  EXPECT_FALSE(after.jumped_back_ns);
  // The same stamp again is a jump of nothing; the interval is the last one.
  const auto same = continuity.Next(260);
  EXPECT_EQ(same.stamp_ns, 1220);
  EXPECT_EQ(same.jumped_back_ns, 0);
}

TEST(StampContinuity, KnowsNoIntervalAfterTheFirstFrame) {
  StampContinuity continuity;
  continuity.Next(1'000'000'000);
  EXPECT_EQ(continuity.Next(5).stamp_ns, 1'033'333'333);
}

}  // namespace
}  // namespace plumbline
