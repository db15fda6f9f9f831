// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/call_or_abandon.h"

#include <functional>
#include <future>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumbline {
namespace call_or_abandon_test {

const auto kGoOn = [] { return true; };

// A call that waits until it is released, at the latest at the end of the test.
class Waiting {
 public:
  ~Waiting() { Release(); }
  std::function<int()> call() const {
    return [released = released_] {
      released.wait();
      return 7;
    };
  }
  void Release() {
    if (!done_) release_.set_value();
    done_ = true;
  }

 private:
  std::promise<void> release_;
  std::shared_future<void> released_ = release_.get_future().share();
  bool done_ = false;
};

TEST(CallOrAbandon, ReturnsTheResultOrRethrows) {
  EXPECT_EQ(CallOrAbandon<int>([] { return 3; }, kGoOn), 3);
  EXPECT_THROW(CallOrAbandon<int>([]() -> int { throw std::bad_alloc(); }, kGoOn), std::bad_alloc);
}

TEST(CallOrAbandon, WaitsForWhatIsSlow) {
  Waiting waiting;
  int asked = 0;
  EXPECT_EQ(CallOrAbandon<int>(waiting.call(),
                               [&] {
                                 if (++asked == 2) waiting.Release();
                                 return true;
                               }),
            7);
  EXPECT_GE(asked, 2);
}

TEST(CallOrAbandon, AbandonsWhatDoesNotAnswer) {
  Waiting waiting;
  int asked = 0;
  EXPECT_FALSE(CallOrAbandon<int>(waiting.call(), [&] { return ++asked < 3; }));
  EXPECT_EQ(asked, 3);
  EXPECT_THROW(CallOrAbandon<int>(waiting.call(), []() -> bool { throw std::runtime_error("no"); }),
               std::runtime_error);
}

}  // namespace call_or_abandon_test
}  // namespace plumbline
