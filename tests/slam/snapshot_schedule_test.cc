// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/snapshot_schedule.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(SnapshotSchedule, ATaskShowsAfterTheLagAndTheStartOfAMapAtOnce) {
  SnapshotSchedule schedule(RunMode::kLockstep, 2);
  schedule.Add(1, 5, true);
  schedule.Add(2, 6, false);
  schedule.Add(3, 7, false);
  EXPECT_EQ(schedule.DueAt(4), 0);
  EXPECT_EQ(schedule.DueAt(5), 1);
  EXPECT_EQ(schedule.DueAt(8), 0) << "nothing new";
  EXPECT_EQ(schedule.DueAt(9), 2);
  EXPECT_EQ(schedule.DueAt(20), 3);
}

TEST(SnapshotSchedule, ALiveRunWaitsForTheStartOfAMapAlone) {
  SnapshotSchedule schedule(RunMode::kLive, 0);
  schedule.Add(1, 0, true);
  schedule.Add(2, 1, false);
  EXPECT_EQ(schedule.DueAt(0), 1);
  EXPECT_EQ(schedule.DueAt(100), 0);
}

TEST(SnapshotSchedule, ATaskThatCouldNotBeSubmittedIsNotWaitedFor) {
  SnapshotSchedule schedule(RunMode::kInline, 0);
  schedule.Add(1, 0, true);
  schedule.Add(2, 0, false);
  schedule.Remove(2);
  EXPECT_EQ(schedule.DueAt(100), 1);
  schedule.Add(2, 100, false);
  schedule.Clear();
  EXPECT_EQ(schedule.DueAt(200), 0);
}

}  // namespace
}  // namespace plumbline
