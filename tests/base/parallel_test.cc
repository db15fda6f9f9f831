// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

// Lets a caller wait until the helper has begun.
class Started {
 public:
  void Set() {
    started_ = true;
    started_.notify_one();
  }
  void Wait() { started_.wait(false); }

 private:
  std::atomic<bool> started_{false};
};

TEST(HelperThread, WorksInItsOwnThreadAsOftenAsItIsAsked) {
  HelperThread helper;
  for (int i = 0; i < 100; ++i) {
    std::thread::id id;
    Started started;
    ASSERT_TRUE(helper.Ask([&] {
      started.Set();
      id = std::this_thread::get_id();
    }));
    started.Wait();
    helper.Finish();
    EXPECT_NE(id, std::thread::id());
    EXPECT_NE(id, std::this_thread::get_id());
  }
}

TEST(HelperThread, HelpsOneCallerAtATime) {
  HelperThread helper;
  int done = 0;
  Started started;
  ASSERT_TRUE(helper.Ask([&] {
    started.Set();
    ++done;
  }));
  EXPECT_FALSE(helper.Ask([&] { done += 10; })) << "the first caller has not finished yet";
  started.Wait();
  helper.Finish();
  EXPECT_EQ(done, 1);
}

TEST(HelperThread, DoesNotBeginWhatHasBeenFinished) {
  HelperThread helper;
  for (int i = 0; i < 1000; ++i) {
    // After Finish the counter is gone: whoever touched it then would be found by the sanitizers.
    auto begun = std::make_unique<std::atomic<int>>(0);
    ASSERT_TRUE(helper.Ask([count = begun.get()] { ++*count; }));
    helper.Finish();
    EXPECT_LE(*begun, 1);
  }
}

TEST(HelperThread, SharesTheCallsOfALoop) {
  HelperThread helper;
  for (const int n : {-1, 0, 1, 2, 1000}) {
    std::vector<int> calls(static_cast<std::size_t>(std::max(n, 0)));
    ParallelFor(n, &helper, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(calls, std::vector<int>(calls.size(), 1));
  }
  HelperThread* const none = nullptr;
  ParallelFor(3, none, [caller = std::this_thread::get_id()](int) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
  });
}

TEST(HelperThread, HelpsAgainAfterACallHasThrown) {
  HelperThread helper;
  for (int repeat = 0; repeat < 50; ++repeat) {
    EXPECT_THROW(ParallelFor(64,
                             &helper,
                             [](int i) {
                               if (i % 7 == 6) throw std::runtime_error("no");
                             }),
                 std::runtime_error);
  }
}

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
