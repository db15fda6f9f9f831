// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/frame_reader.h"

#include "tests/report/poster_run.h"
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr std::size_t kUnreadable = 1, kFailing = 2, kBlocking = 3;

// Answers some frames in special ways; one only when it is allowed to.
class SlowDataset : public PosterDataset {
 public:
  SlowDataset() : PosterDataset(6) {}
  ~SlowDataset() override { Release(); }

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    if (i == kUnreadable) return ImageFailure{"image.png", "cannot be read"};
    if (i == kFailing) throw std::bad_alloc();
    if (i == kBlocking) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return released_; });
    }
    return PosterDataset::Read(i);
  }

  void Release() const {
    const std::lock_guard lock(mutex_);
    released_ = true;
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable bool released_ = false;
};

const auto kGoOn = [] { return true; };

TEST(FrameReader, ReadsWhatTheDataSetHas) {
  FrameReader reader(std::make_shared<SlowDataset>());
  for (const std::size_t i : {4U, 0U, 5U}) {
    const auto frame = reader.Read(i, kGoOn);
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->stamp_ns, MovingPoster::StampNs(static_cast<int>(i)));
  }
  const auto unreadable = reader.Read(kUnreadable, kGoOn);
  ASSERT_TRUE(unreadable);
  EXPECT_EQ(unreadable->error().why, "cannot be read");
}

TEST(FrameReader, RethrowsAndGoesOn) {
  FrameReader reader(std::make_shared<SlowDataset>());
  EXPECT_THROW(reader.Read(kFailing, kGoOn), std::bad_alloc);
  EXPECT_TRUE(reader.Read(0, kGoOn));
}

TEST(FrameReader, GivesUpWhatDoesNotAnswer) {
  const auto dataset = std::make_shared<SlowDataset>();
  const auto start = std::chrono::steady_clock::now();
  int asked = 0;
  {
    FrameReader reader(dataset);
    EXPECT_FALSE(reader.Read(kBlocking, [&] { return ++asked < 3; }));
  }
  EXPECT_EQ(asked, 3);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(250));
  dataset->Release();
}

// Who asks may throw in place of saying no, as Python does when it is interrupted.
TEST(FrameReader, GivesUpWhereGoOnThrows) {
  const auto dataset = std::make_shared<SlowDataset>();
  {
    FrameReader reader(dataset);
    EXPECT_THROW(reader.Read(kBlocking, []() -> bool { throw std::runtime_error("interrupted"); }),
                 std::runtime_error);
  }  // does not wait for the frame
  dataset->Release();
}

TEST(FrameReader, WaitsForWhatIsSlow) {
  const auto dataset = std::make_shared<SlowDataset>();
  FrameReader reader(dataset);
  int asked = 0;
  const auto frame = reader.Read(kBlocking, [&] {
    if (++asked == 2) dataset->Release();
    return true;
  });
  EXPECT_TRUE(frame && *frame);
  EXPECT_GE(asked, 2);
}

}  // namespace
}  // namespace plumbline
