// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/playback_schedule.h"

#include <chrono>
#include <cstdint>

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

namespace playback_schedule_test {

using Clock = PlaybackSchedule::Clock;
using std::chrono::milliseconds;

Clock::time_point At(int ms) { return Clock::time_point(milliseconds(ms)); }
std::int64_t Stamp(int ms) { return std::int64_t{1'000'000} * ms; }

TEST(PlaybackSchedule, GivesFramesOutAsFarApartAsTheyWereTaken) {
  PlaybackSchedule schedule;
  EXPECT_LT(schedule.ReadAt(Stamp(700)), At(0)) << "the first one at once";
  EXPECT_EQ(schedule.DueOnceRead(Stamp(700), At(1000), At(1040)), At(1040));
  EXPECT_EQ(schedule.DueOnceRead(Stamp(800), At(1090), At(1110)), At(1140));
  EXPECT_EQ(schedule.DueOnceRead(Stamp(5800), At(6100), At(6120)), At(6140)) << "behind a gap";
}

TEST(PlaybackSchedule, ReadsAsLongBeforeAFrameIsDueAsReadingTakes) {
  PlaybackSchedule schedule;
  schedule.DueOnceRead(Stamp(0), At(1000), At(1040));
  EXPECT_EQ(schedule.ReadAt(Stamp(100)), At(1140 - 50)) << "a quarter more than it took";
  schedule.DueOnceRead(Stamp(100), At(1090), At(1170));
  EXPECT_EQ(schedule.ReadAt(Stamp(200)), At(1240 - 100));
}

TEST(PlaybackSchedule, AFrameThatIsReadLateDelaysNoOthers) {
  PlaybackSchedule schedule;
  schedule.DueOnceRead(Stamp(0), At(1000), At(1000));
  EXPECT_EQ(schedule.DueOnceRead(Stamp(100), At(1100), At(1400)), At(1100));
  EXPECT_EQ(schedule.DueOnceRead(Stamp(200), At(1400), At(1410)), At(1200));
}

TEST(PlaybackSchedule, IsLaterByAPause) {
  PlaybackSchedule schedule;
  schedule.Delay(milliseconds(30));
  EXPECT_EQ(schedule.DueOnceRead(Stamp(0), At(1000), At(1000)), At(1000)) << "nothing was due yet";
  schedule.Delay(milliseconds(500));
  EXPECT_EQ(schedule.ReadAt(Stamp(100)), At(1600));
  EXPECT_EQ(schedule.DueOnceRead(Stamp(100), At(1600), At(1600)), At(1600));
}

}  // namespace playback_schedule_test

}  // namespace plumbline
