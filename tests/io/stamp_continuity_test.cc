// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/stamp_continuity.h"

#include <cstdint>
#include <vector>

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

TEST(StampContinuity, ComesBackFromStampsThatWereNotSet) {
  StampContinuity continuity;
  constexpr std::int64_t kStart = 1'764'000'000'000'000'000, kStep = 100'000'000;
  std::vector<std::int64_t> given;
  for (int i = 0; i < 6; ++i) {
    const bool set = i < 2 || i % 2 == 1;
    given.push_back(continuity.Next(set ? kStart + i * kStep : 0).stamp_ns);
  }
  for (int i = 0; i < 6; ++i) EXPECT_EQ(given[static_cast<std::size_t>(i)], kStart + i * kStep);
}

TEST(StampContinuity, GoesOnByASecondAtMost) {
  StampContinuity continuity;
  continuity.Next(0);
  continuity.Next(3'600'000'000'000);
  EXPECT_EQ(continuity.Next(0).stamp_ns, 3'601'000'000'000);
}

TEST(StampContinuity, GivesNoStampThatCannotBeWritten) {
  for (const std::int64_t far : {1'764'000'000'000'000'000, 4'000'000'000'000'000'000}) {
    StampContinuity continuity;
    std::int64_t last = -1;
    for (int i = 0; i < 20; ++i) {
      const std::int64_t next = continuity.Next(i % 2 == 0 ? 0 : far).stamp_ns;
      EXPECT_GT(next, last);
      EXPECT_LE(next, 4'000'000'000'000'000'000 + i);
      last = next;
    }
  }
}

}  // namespace
}  // namespace plumbline
