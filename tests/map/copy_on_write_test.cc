// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/copy_on_write.h"

#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(CopyOnWrite, CopiesShareTheirValueUntilOneIsChanged) {
  CopyOnWrite<std::string> first(std::string("as it was"));
  const CopyOnWrite<std::string> second = first;
  EXPECT_EQ(&*first, &*second);
  first.Own() = "changed";
  EXPECT_EQ(*first, "changed");
  EXPECT_EQ(*second, "as it was");
}

TEST(CopyOnWrite, OneAloneIsChangedInItsPlace) {
  CopyOnWrite<int> value(1);
  const int* place = &*value;
  { const CopyOnWrite<int> gone = value; }
  value.Own() = 2;
  EXPECT_EQ(&*value, place);
  const CopyOnWrite<int> moved = std::move(value);
  EXPECT_EQ(&*moved, place);
  EXPECT_EQ(*moved, 2);
}

TEST(CopyOnWrite, MayHaveNoValue) {
  CopyOnWrite<int> none;
  EXPECT_FALSE(none);
  const CopyOnWrite<int> copy = none;
  EXPECT_FALSE(copy);
  none = CopyOnWrite<int>(3);
  EXPECT_TRUE(none);
  none = copy;
  EXPECT_FALSE(none);
}

// Copies are read and given up in other threads while this one goes on changing its own.
TEST(CopyOnWrite, OtherThreadsReadWhatTheyHave) {
  CopyOnWrite<std::vector<int>> value(std::vector<int>(1000, 0));
  std::vector<std::jthread> readers;
  std::vector<char> alike(20, 0);
  for (int round = 0; round < 20; ++round) {
    readers.emplace_back([copy = value, &good = alike[static_cast<std::size_t>(round)], round] {
      good = *copy == std::vector<int>(1000, round);
    });
    for (int& entry : value.Own()) ++entry;
  }
  readers.clear();
  EXPECT_EQ(alike, std::vector<char>(20, 1));
}

}  // namespace
}  // namespace plumbline
