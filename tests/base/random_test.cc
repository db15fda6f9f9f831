// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Rng, GivesTheSameNumbersOnEveryMachine) {
  Rng rng(1, "x", 2);
  EXPECT_EQ(rng.Next(), 0x62752ee133f37164U);
  EXPECT_EQ(rng.Next(), 0xede72a484e5ea550U);
  EXPECT_EQ(rng.Next(), 0x32493a0f8deebb1fU);
  EXPECT_EQ(Rng(1).Uniform(), 0.1472418062741967);
}

TEST(Rng, SeedNameAndIndexEachMakeAnotherStream) {
  const std::uint64_t first = Rng(1, "a", 1).Next();
  EXPECT_EQ(first, Rng(1, "a", 1).Next());
  EXPECT_NE(first, Rng(2, "a", 1).Next());
  EXPECT_NE(first, Rng(1, "b", 1).Next());
  EXPECT_NE(first, Rng(1, "a", 2).Next());
}

TEST(Rng, UniformFillsTheUnitInterval) {
  Rng rng(3);
  double sum = 0;
  double squares = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double x = rng.Uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.004);
  EXPECT_NEAR(squares / kCount, 1.0 / 3, 0.004);
  const double y = rng.Uniform(-5, -3);
  EXPECT_TRUE(y >= -5 && y < -3);
}

TEST(Rng, NormalHasItsMomentsAndTails) {
  Rng rng(4);
  double sum = 0;
  double squares = 0;
  int beyond_two = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double x = rng.Normal(3);
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
    beyond_two += std::abs(x) > 6 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.05);
  EXPECT_NEAR(squares / kCount, 9, 0.2);
  EXPECT_NEAR(beyond_two / static_cast<double>(kCount), 0.0455, 0.003);
}

TEST(Rng, IndexIsEvenAndRefusesNothing) {
  Rng rng(5);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) ++counts.at(rng.Index(7));
  for (const int count : counts) EXPECT_NEAR(count, 10000, 500);
  EXPECT_EQ(rng.Index(1), 0U);
  EXPECT_THROW((void)rng.Index(0), BugError);
}

TEST(Rng, ShuffleMakesEveryOrder) {
  Rng rng(6);
  std::map<std::array<int, 3>, int> seen;
  for (int i = 0; i < 6000; ++i) {
    std::vector<int> v = {0, 1, 2};
    rng.Shuffle(v);
    ++seen[{v[0], v[1], v[2]}];
  }
  EXPECT_EQ(seen.size(), 6U);
  for (const auto& [order, count] : seen) EXPECT_NEAR(count, 1000, 150);
  std::vector<int> empty;
  rng.Shuffle(empty);
}

}  // namespace
}  // namespace plumbline
