// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/read_ahead.h"

#include "plumbline/base/error.h"

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace read_ahead_test {

// Frames whose left image is as wide as their index is large. Frame 3 cannot be read, frame 5
// throws. Counts the calls of Read.
class CountedDataset : public Dataset {
 public:
  CountedDataset() : Dataset(WithStamps()) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    {
      const std::lock_guard lock(mutex_);
      readers_[i].push_back(std::this_thread::get_id());
      read_.notify_all();
    }
    if (i == 3) return ImageFailure{"third.png", "it is cut short"};
    if (i == 5) throw InputError("five");
    return SensorFrame{stamp_ns(i), GrayImage(static_cast<int>(i) + 1, 1), {}, {}};
  }

  // Waits until a frame has been asked for.
  void WaitFor(std::size_t i) const {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(
        read_.wait_for(lock, std::chrono::seconds(20), [&] { return readers_.contains(i); }));
  }

  std::vector<std::thread::id> ReadersOf(std::size_t i) const {
    const std::lock_guard lock(mutex_);
    return readers_.contains(i) ? readers_.at(i) : std::vector<std::thread::id>{};
  }

 private:
  static DatasetInfo WithStamps() {
    DatasetInfo info;
    for (int i = 0; i < 8; ++i) info.stamps_ns.push_back(100 * i);
    return info;
  }

  mutable std::mutex mutex_;
  mutable std::condition_variable read_;
  mutable std::map<std::size_t, std::vector<std::thread::id>> readers_;
};

TEST(ReadAhead, ReadsTheNextFrameInAnotherThreadMeanwhile) {
  const CountedDataset dataset;
  ReadAhead ahead(dataset);
  EXPECT_EQ(ahead.Read(0, 2)->left.width(), 1);
  dataset.WaitFor(2);  // nobody has asked for it yet
  EXPECT_EQ(ahead.Read(2, std::nullopt)->left.width(), 3);
  ASSERT_EQ(dataset.ReadersOf(2).size(), 1U);
  EXPECT_NE(dataset.ReadersOf(2).front(), std::this_thread::get_id());
  EXPECT_TRUE(dataset.ReadersOf(3).empty());
}

TEST(ReadAhead, FailsForTheFrameThatCannotBeRead) {
  const CountedDataset dataset;
  ReadAhead ahead(dataset);
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    const auto next = i + 1 < dataset.size() ? std::optional(i + 1) : std::nullopt;
    if (i == 5) {
      dataset.WaitFor(5);
      EXPECT_THROW(ahead.Read(i, next), InputError);
      continue;
    }
    const auto read = ahead.Read(i, next);
    if (next) dataset.WaitFor(*next);
    ASSERT_EQ(static_cast<bool>(read), i != 3) << i;
    if (i == 3) {
      EXPECT_EQ(read.error().why, "it is cut short");
    } else {
      EXPECT_EQ(read->left.width(), static_cast<int>(i) + 1);
    }
  }
}

TEST(ReadAhead, ReadsWhatIsAskedForWhateverWasAnnounced) {
  const CountedDataset dataset;
  ReadAhead ahead(dataset);
  EXPECT_EQ(ahead.Read(0, 1)->left.width(), 1);
  dataset.WaitFor(1);
  EXPECT_EQ(ahead.Read(7, 6)->left.width(), 8);
}

}  // namespace read_ahead_test
}  // namespace plumbline
