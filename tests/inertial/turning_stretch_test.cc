// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/turning_stretch.h"

#include "plumbline/base/units.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// A day at 20 Hz that turns by `rate` and, for a minute at noon, twice as fast.
InertialSample SampleOfDay(std::int64_t i) {
  constexpr std::int64_t kNoon = 12 * 3600 * 20, kMinute = 60 * 20;
  const double rate = i >= kNoon && i < kNoon + kMinute ? 2 : 1;
  return {i * kNsPerSecond / 20, {rate, 0, 0}, {0, 0, 9.81}};
}

TEST(TurningStretch, KeepsAllOfAShortRun) {
  TurningStretch stretch;
  EXPECT_TRUE(stretch.best().empty());
  std::vector<InertialSample> samples;
  for (std::int64_t i = 0; i < 5000; ++i) samples.push_back(SampleOfDay(i));
  stretch.Add(std::span(samples).first(1200));
  stretch.Add(std::span(samples).subspan(1200));
  ASSERT_EQ(stretch.best().size(), samples.size());
  EXPECT_EQ(stretch.best().front().stamp_ns, 0);
  EXPECT_EQ(stretch.best().back().stamp_ns, samples.back().stamp_ns);
}

TEST(TurningStretch, HoldsNoMoreOfADayThanOfAnHourAndKeepsWhatTurnsMost) {
  TurningStretch stretch;
  std::size_t most_of_an_hour = 0, most = 0;
  for (std::int64_t i = 0; i < 24 * 3600 * 20; ++i) {
    const InertialSample sample = SampleOfDay(i);
    stretch.Add(std::span(&sample, 1));
    most = std::max(most, stretch.held());
    if (i < 3600 * 20) most_of_an_hour = most;
  }
  EXPECT_EQ(most, most_of_an_hour);
  const auto best = stretch.best();
  EXPECT_LE(best.size(), 12'001U);
  EXPECT_TRUE(std::any_of(best.begin(), best.end(), [](const InertialSample& sample) {
    return sample.angular_rate.x() == 2;
  }));
}

}  // namespace
}  // namespace plumbline
