// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/random.h"
#include "plumbline/io/map_file/map_io.h"

#include "tests/io/map_fixture.h"
#include "tests/io/scratch_folder.h"
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

// A map of half a megabyte, which takes some milliseconds to be saved.
Map LargeMap(std::int64_t keyframes) {
  Rng rng(4);
  Map map;
  for (std::int64_t k = 0; k < keyframes; ++k) {
    KeyFrame keyframe = MakeKeyFrame(k, k - 1);
    Features features = keyframe.frame.features();
    for (int i = 0; i < 1000; ++i) {
      PointFeature point;
      point.px = {rng.Uniform(0, 752), rng.Uniform(0, 480)};
      for (std::uint64_t& word : point.descriptor) word = rng.Next();
      features.points.push_back(point);
      features.point_disparity.push_back({});
    }
    keyframe.frame.points.resize(features.points.size());
    keyframe.frame.indexed = IndexFeatures(kMapCamera, std::move(features));
    map.Apply({edit::AddKeyFrame{std::move(keyframe)}});
  }
  return map;
}

// Runs `child` in a process of its own, which it does not leave; gives its id.
pid_t Fork(const std::function<void()>& child) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  try {
    child();
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

int WaitFor(pid_t pid) {
  int status = 0;
  EXPECT_EQ(::waitpid(pid, &status, 0), pid);
  return status;
}

class SavingKilled : public testing::Test {
 protected:
  void Save(const Map& map) const { SaveMap(file_, kMapCamera, kMapRotation, map); }

  // What is there is one of the two maps, whole.
  void ExpectComplete() const {
    const Map loaded = LoadMap(file_).map;
    loaded.CheckInvariants();
    const auto size = loaded.keyframes().size();
    EXPECT_TRUE(size == small_.keyframes().size() || size == large_.keyframes().size()) << size;
  }

  ScratchFolder folder_;
  std::filesystem::path file_ = folder_ / "m.plb";
  Map small_ = LargeMap(6);
  Map large_ = LargeMap(12);
};

TEST_F(SavingKilled, LeavesTheLastCompleteFileAtAnyTime) {
  Save(small_);
  const auto start = Clock::now();
  Save(large_);
  const std::chrono::duration<double> taken = Clock::now() - start;
  Rng rng(6);
  for (int k = 0; k < 50; ++k) {
    const pid_t pid = Fork([&] {
      while (true) {
        Save(small_);
        Save(large_);
      }
    });
    ASSERT_GT(pid, 0);
    std::this_thread::sleep_for(rng.Uniform(0, 1.5) * taken);
    ASSERT_EQ(::kill(pid, SIGKILL), 0);
    EXPECT_EQ(WTERMSIG(WaitFor(pid)), SIGKILL);
    ExpectComplete();
  }
}

// The system kills a process that writes beyond its limit, at exactly this byte.
TEST_F(SavingKilled, LeavesTheLastCompleteFileAtAnyByte) {
  Save(large_);
  const auto size = static_cast<double>(std::filesystem::file_size(file_));
  Save(small_);
  const std::string before = Contents(file_);
  Rng rng(7);
  for (int k = 0; k < 20; ++k) {
    const auto limit = static_cast<rlim_t>(rng.Uniform(0, size));
    const pid_t pid = Fork([&] {
      const rlimit limits{limit, limit};
      const rlimit no_core{0, 0};
      ::setrlimit(RLIMIT_CORE, &no_core);
      ::setrlimit(RLIMIT_FSIZE, &limits);
      ::signal(SIGXFSZ, SIG_DFL);
      Save(large_);
    });
    ASSERT_GT(pid, 0);
    const int status = WaitFor(pid);
    EXPECT_TRUE(WIFSIGNALED(status)) << limit;
    EXPECT_EQ(WTERMSIG(status), SIGXFSZ) << limit;
    EXPECT_EQ(Contents(file_), before);
  }
  ExpectComplete();
}

}  // namespace
}  // namespace plumbline
