// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/inertial_input.h"

#include "plumbline/base/units.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace inertial_input_test {

constexpr std::int64_t kInterval = 5'000'000;  // 200 Hz

// Samples at 200 Hz without end, made as they are asked for.
class Endless : public InertialStream {
 public:
  explicit Endless(std::int64_t* made) : made_(made) {}
  std::optional<InertialSample> Next() override {
    return InertialSample{(*made_)++ * kInterval, {0.1, 0, 0}, {0, 0, 9.81}};
  }

 private:
  std::int64_t* made_;
};

InertialRecording EndlessRecording(std::int64_t* made) {
  InertialRecording recording;
  recording.open = [made] { return std::make_unique<Endless>(made); };
  return recording;
}

TEST(InertialFeed, GivesEachFrameTheSamplesSinceTheOneBeforeAndReadsNoSooner) {
  std::int64_t made = 0;
  const InertialRecording recording = EndlessRecording(&made);
  InertialFeed feed(&recording);
  EXPECT_EQ(feed.UpTo(0).size(), 5U);  // 20 ms more
  EXPECT_LE(made, 6);
  const auto next = feed.UpTo(50'000'000);
  ASSERT_EQ(next.size(), 10U);
  EXPECT_EQ(next.front().stamp_ns, 25'000'000);
  EXPECT_EQ(next.back().stamp_ns, 70'000'000);
  // Those of frames that a stride leaves out come with the next one.
  EXPECT_EQ(feed.UpTo(200'000'000).size(), 30U);
  EXPECT_EQ(feed.UpTo(200'000'000).size(), 0U);
}

TEST(InertialFeed, ReadsOnForTheCheckAfterTheRun) {
  std::int64_t made = 0;
  const InertialRecording recording = EndlessRecording(&made);
  InertialFeed feed(&recording);
  feed.UpTo(1'000'000'000);
  const auto telling = feed.Telling();
  ASSERT_FALSE(telling.empty());
  EXPECT_EQ(telling.front().stamp_ns, 0);
  EXPECT_EQ(telling.back().stamp_ns, 1'520'000'000);
  InertialFeed none(nullptr);
  EXPECT_TRUE(none.Telling().empty());
}

TEST(InertialFeed, HoldsNoMoreOfADayThanOfAnHour) {
  std::int64_t made = 0;
  const InertialRecording recording = EndlessRecording(&made);
  InertialFeed feed(&recording);
  constexpr std::int64_t kHour = 3600 * kNsPerSecond;
  std::size_t most_of_an_hour = 0, most = 0;
  for (std::int64_t ns = 0; ns < 24 * kHour; ns += kNsPerSecond) {
    feed.UpTo(ns);
    most = std::max(most, feed.held());
    if (ns < kHour) most_of_an_hour = most;
  }
  EXPECT_GT(made, 17'000'000);
  EXPECT_EQ(most, most_of_an_hour);
  EXPECT_LT(most, 250'000U);
}

TEST(InertialFeed, SamplesOfAnotherDayAreNotHeld) {
  std::int64_t made = 0;
  const InertialRecording recording = EndlessRecording(&made);
  InertialFeed feed(&recording);
  EXPECT_EQ(feed.UpTo(3600 * kNsPerSecond).size(), 60'000U);  // the newest
  EXPECT_LT(feed.held(), 250'000U);
}

TEST(InertialFeed, GivesTheSamplesOfALiveSourceInOrder) {
  InertialRecording recording;
  recording.calibration.time_offset = 0.1;
  InertialFeed feed(&recording);
  std::vector<InertialSample> samples;
  for (const std::int64_t ms : {80, 90, 100, 95, 100, 125, 300}) {
    samples.push_back({ms * 1'000'000, {}, {}});
  }
  feed.Add(samples);
  EXPECT_EQ(feed.UpTo(10'000'000).size(), 4U);
  EXPECT_EQ(feed.UpTo(500'000'000).size(), 1U);
  InertialFeed none(nullptr);
  none.Add(samples);
  EXPECT_TRUE(none.UpTo(10'000'000).empty());
}

TEST(InertialFeed, OneStampFarAheadDoesNotEndALiveSensor) {
  const InertialRecording recording;
  InertialFeed feed(&recording);
  std::size_t given = 0;
  for (std::int64_t i = 0; i < 100; ++i) {
    const std::int64_t ahead = i == 3 ? 15 * kNsPerSecond : 0;
    feed.Add(std::vector<InertialSample>{{i * kInterval + ahead, {}, {}}});
    given += feed.UpTo(i * kInterval).size();
  }
  EXPECT_EQ(given, 99U);
  OrderedSamples left_out;
  feed.CountInto(left_out);
  EXPECT_EQ(left_out.ahead, 1U);
  EXPECT_EQ(left_out.backward, 0U);
}

}  // namespace inertial_input_test
}  // namespace plumbline
