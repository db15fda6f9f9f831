// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/optional_list.h"

#include "plumbline/base/random.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

void ExpectSame(const OptionalList<int>& list, const std::vector<std::optional<int>>& expected) {
  ASSERT_EQ(list.size(), expected.size());
  std::size_t i = 0;
  std::size_t present = 0;
  for (const std::optional<int> entry : list) {
    EXPECT_EQ(entry, expected[i]) << i;
    EXPECT_EQ(list[i].has_value(), expected[i].has_value()) << i;
    present += expected[i].has_value();
    ++i;
  }
  EXPECT_EQ(list.values().size(), present);
}

TEST(OptionalList, HoldsWhatAVectorOfOptionalsHolds) {
  Rng rng(1, "optional_list");
  OptionalList<int> list;
  std::vector<std::optional<int>> expected;
  for (int step = 0; step < 2000; ++step) {
    const auto any = [&](std::size_t count) {
      return static_cast<std::size_t>(rng.Uniform(0, static_cast<double>(count)));
    };
    const std::optional<int> value = rng.Uniform() < 0.5 ? std::optional(step) : std::nullopt;
    if (const double choice = rng.Uniform(); choice < 0.4 || expected.empty()) {
      list.push_back(value);
      expected.push_back(value);
    } else if (choice < 0.9) {
      const std::size_t i = any(expected.size());
      list.Set(i, value);
      expected[i] = value;
    } else {
      const std::size_t size = any(2 * expected.size());
      list.resize(size);
      expected.resize(size);
    }
    ExpectSame(list, expected);
  }
  ExpectSame(expected, expected);
}

TEST(OptionalList, TakesNoMemoryWithoutValues) {
  OptionalList<double> list;
  list.resize(1000);
  EXPECT_EQ(list.Bytes(), 0U);
  EXPECT_EQ(OptionalList<double>(std::vector<std::optional<double>>(1000)).Bytes(), 0U);
  list.Set(3, 0.5);
  EXPECT_LT(list.Bytes(), 1000 * sizeof(std::optional<double>));
  *list.Find(3) = 0.25;
  EXPECT_EQ(*list[3], 0.25);
  list.clear();
  EXPECT_TRUE(list.empty());
}

}  // namespace
}  // namespace plumbline
