// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/parallel.h"

#include "plumbline/base/helper_thread.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ParallelMap, ResultDoesNotDependOnThreads) {
  const auto square = [](int i) { return i * i; };
  const std::vector<int> serial = ParallelMap<int>(1000, 1, square);
  EXPECT_EQ(serial[31], 961);
  for (const int threads : {2, 3, 8, 2000}) {
    EXPECT_EQ(ParallelMap<int>(1000, threads, square), serial);
  }
}

TEST(ParallelFor, OneThreadIsTheCallers) {
  std::set<std::thread::id> ids;
  ParallelFor(10, 1, [&](int) { ids.insert(std::this_thread::get_id()); });
  EXPECT_EQ(ids, std::set{std::this_thread::get_id()});
}

TEST(ParallelForRanges, MakesUpAllIndicesInOrder) {
  HelperThread helper;
  for (HelperThread* who : {static_cast<HelperThread*>(nullptr), &helper}) {
    std::vector<int> seen(10, 0);
    ParallelForRanges(seen.size(), 4, who, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 4, 0U);
      EXPECT_EQ(end, std::min<std::size_t>(begin + 4, 10));
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
    EXPECT_EQ(seen, std::vector<int>(10, 1));
    ParallelForRanges(0, 4, who, [](std::size_t, std::size_t) { FAIL(); });
  }
}

TEST(ParallelFor, HasNothingToDoForNoItems) {
  for (const int n : {0, -1}) {
    ParallelFor(n, 4, [](int) { FAIL(); });
    EXPECT_TRUE(ParallelMap<int>(n, 4, [](int i) { return i; }).empty());
  }
}

TEST(ParallelFor, RethrowsTheExceptionOfTheLeastIndex) {
  for (const int threads : {1, 2, 4}) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      try {
        ParallelFor(64, threads, [](int i) {
          if (i == 7 || i == 8 || i == 60) throw std::runtime_error(std::to_string(i));
        });
        FAIL() << "no exception";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "7");
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
