// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/inertial_samples.h"

#include "tests/inertial/invented_motion.h"
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Samples = std::vector<InertialSample>;

InertialSample At(std::int64_t stamp_ns, double value = 0) {
  return {stamp_ns, Eigen::Vector3d::Constant(value), Eigen::Vector3d::Constant(-value)};
}

TEST(InOrderOfTime, LeavesOutWhatDoesNotIncrease) {
  const OrderedSamples ordered =
      InOrderOfTime(Samples{At(1), At(3), At(2), At(3), At(3), At(4), At(0), At(9)});
  ASSERT_EQ(ordered.samples.size(), 4U);
  EXPECT_EQ(ordered.samples[2].stamp_ns, 4);
  EXPECT_EQ(ordered.samples[3].stamp_ns, 9);
  EXPECT_EQ(ordered.backward, 2U);
  EXPECT_EQ(ordered.repeated, 2U);
  EXPECT_TRUE(InOrderOfTime({}).samples.empty());
}

TEST(JoinedSamples, InterpolatesTheSlowerOneWhicheverItIs) {
  // A gyroscope at 400 Hz and an accelerometer at 250 Hz, and the other way round.
  for (const bool gyroscope_faster : {true, false}) {
    const Samples gyroscope = IdealSamples(gyroscope_faster ? 400 : 250);
    Samples accelerometer = IdealSamples(gyroscope_faster ? 250 : 400);
    const Samples joined = JoinedSamples(gyroscope, accelerometer);
    EXPECT_NEAR(MedianInterval(joined), 1 / 400.0, 1e-9);
    ASSERT_GT(joined.size(), 470U);
    for (const InertialSample& sample : joined) {
      const InertialSample ideal =
          IdealSample(static_cast<double>(sample.stamp_ns - kMotionStart) / 1e9);
      EXPECT_LT((sample.angular_rate - ideal.angular_rate).norm(), 1e-4);
      EXPECT_LT((sample.specific_force - ideal.specific_force).norm(), 1e-3);
    }
  }
}

TEST(JoinedSamples, LeavesOutStampsThatTheOtherOneDoesNotReach) {
  const Samples fast = {At(0), At(1), At(2), At(3), At(4), At(5), At(6)};
  const Samples slow = {At(1, 1), At(3, 3), At(5, 5)};
  const Samples joined = JoinedSamples(fast, slow);
  ASSERT_EQ(joined.size(), 5U);
  EXPECT_EQ(joined.front().stamp_ns, 1);
  EXPECT_EQ(joined[1].specific_force.x(), -2);
  EXPECT_EQ(joined[1].angular_rate.x(), 0);
  EXPECT_EQ(joined.back().stamp_ns, 5);
  EXPECT_TRUE(JoinedSamples(fast, {}).empty());
  EXPECT_TRUE(JoinedSamples({}, slow).empty());
}

TEST(SampleJoiner, JoinsAsTheyComeInWhateverTurn) {
  const Samples fast = {At(0), At(1), At(2), At(3), At(4), At(5), At(6)};
  const Samples slow = {At(1, 1), At(3, 3), At(5, 5)};
  const Samples whole = JoinedSamples(fast, slow);
  // Those of the slower one come late, or all before.
  for (const bool late : {true, false}) {
    SampleJoiner joiner(true);
    Samples joined;
    const auto take = [&] {
      while (const auto sample = joiner.Take()) joined.push_back(*sample);
    };
    if (late) {
      for (const InertialSample& sample : fast) joiner.AddRates(sample);
      take();
      EXPECT_TRUE(joined.empty());
    }
    for (const InertialSample& sample : slow) joiner.AddForces(sample), take();
    if (!late) {
      for (const InertialSample& sample : fast) joiner.AddRates(sample), take();
    }
    ASSERT_EQ(joined.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(joined[i].stamp_ns, whole[i].stamp_ns);
      EXPECT_EQ(joined[i].specific_force, whole[i].specific_force);
    }
  }
}

TEST(SampleJoiner, GivesUpTheOldestWhereTheSlowerOneIsSilent) {
  SampleJoiner joiner(true);
  joiner.AddForces(At(0, 1));
  for (int i = 1; i <= 25'000; ++i) joiner.AddRates(At(i));
  joiner.AddForces(At(25'000, 1));
  std::size_t joined = 0;
  while (joiner.Take()) ++joined;
  EXPECT_EQ(joined, 10'000U);
}

constexpr std::int64_t kMs = 1'000'000, kYears = 1'000'000'000'000'000'000;

std::vector<std::int64_t> StampsOf(const OrderedSamples& ordered) {
  std::vector<std::int64_t> stamps;
  for (const InertialSample& sample : ordered.samples) stamps.push_back(sample.stamp_ns / kMs);
  return stamps;
}

TEST(InOrderOfTime, LeavesOutASampleThatIsFarAheadOfTheNextOne) {
  using Stamps = std::vector<std::int64_t>;
  // In the midst, as the first one, and ahead by 15 s.
  const OrderedSamples midst =
      InOrderOfTime(Samples{At(0), At(5 * kMs), At(kYears), At(10 * kMs), At(15 * kMs)});
  EXPECT_EQ(StampsOf(midst), (Stamps{0, 5, 10, 15}));
  EXPECT_EQ(midst.ahead, 1U);
  EXPECT_EQ(midst.backward, 0U);
  const OrderedSamples first = InOrderOfTime(Samples{At(kYears), At(5 * kMs), At(10 * kMs)});
  EXPECT_EQ(StampsOf(first), (Stamps{5, 10}));
  EXPECT_EQ(first.ahead, 1U);
  EXPECT_EQ(StampsOf(InOrderOfTime(Samples{At(0), At(15'005 * kMs), At(10 * kMs)})),
            (Stamps{0, 10}));
  // Up to four in a row, whatever they are, and the first ones.
  const OrderedSamples several = InOrderOfTime(Samples{At(kYears),
                                                       At(kYears + 1),
                                                       At(0),
                                                       At(5 * kMs),
                                                       At(kYears),
                                                       At(3 * kYears),
                                                       At(4 * kYears),
                                                       At(4 * kYears + 1),
                                                       At(10 * kMs),
                                                       At(15 * kMs)});
  EXPECT_EQ(StampsOf(several), (Stamps{0, 5, 10, 15}));
  EXPECT_EQ(several.ahead, 6U);
  // A pause is none, also where a sample goes back behind it.
  const OrderedSamples pause =
      InOrderOfTime(Samples{At(0), At(3000 * kMs), At(2999 * kMs), At(3005 * kMs), At(9000 * kMs)});
  EXPECT_EQ(StampsOf(pause), (Stamps{0, 3000, 3005, 9000}));
  EXPECT_EQ(pause.ahead, 0U);
  EXPECT_EQ(pause.backward, 1U);
}

TEST(TimeOrder, WaitsForFiveWhereASampleIsFarAhead) {
  TimeOrder order;
  std::vector<std::size_t> taken;
  for (const std::int64_t ms : {0, 5, 10, 15, 20, 25, 2000, 2005, 2010, 2015, 2020, 2025}) {
    order.Add(At(ms * kMs));
    taken.push_back(0);
    while (order.Take()) ++taken.back();
  }
  EXPECT_EQ(taken, (std::vector<std::size_t>{0, 0, 0, 0, 5, 1, 0, 0, 0, 0, 5, 1}));
}

TEST(IsPlausible, RefusesWhatNoSensorMeasures) {
  EXPECT_TRUE(IsPlausible(At(0, 1e6)));
  EXPECT_FALSE(IsPlausible(At(0, 1.1e6)));
  EXPECT_FALSE(IsPlausible(At(0, 1e300)));
  EXPECT_FALSE(IsPlausible({0, Eigen::Vector3d(0, std::nan(""), 0), Eigen::Vector3d::Zero()}));
}

}  // namespace
}  // namespace plumbline
