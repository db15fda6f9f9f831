// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros/frame_pairs.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace {

using testing::ElementsAre;
using testing::Pair;

// Pairs of messages whose only byte is their stamp.
class Pairs {
 public:
  explicit Pairs(bool approximate, std::size_t queue_size = 5)
      : pairs_(approximate, queue_size, [this](const Bytes& first, const Bytes& second) {
          taken.emplace_back(first[0], second[0]);
        }) {}

  void First(int stamp) { pairs_.AddFirst(stamp, {static_cast<std::uint8_t>(stamp)}); }
  void Second(int stamp) { pairs_.AddSecond(stamp, {static_cast<std::uint8_t>(stamp)}); }

  std::vector<std::pair<int, int>> taken;

 private:
  FramePairs pairs_;
};

TEST(FramePairs, AreThoseOfEqualStampsWhateverComesFirst) {
  Pairs pairs(false);
  pairs.First(10);
  pairs.First(20);
  pairs.Second(20);
  pairs.Second(30);
  EXPECT_THAT(pairs.taken, ElementsAre(Pair(20, 20)));
  pairs.First(30);
  pairs.First(41);
  pairs.Second(40);
  EXPECT_THAT(pairs.taken, ElementsAre(Pair(20, 20), Pair(30, 30)));
}

TEST(FramePairs, KeepOnlyTheQueue) {
  Pairs pairs(false, 2);
  for (const int stamp : {10, 20, 30}) pairs.First(stamp);
  pairs.Second(10);
  pairs.Second(20);
  EXPECT_THAT(pairs.taken, ElementsAre(Pair(20, 20)));
}

TEST(FramePairs, BeginAnewWhereABagDoes) {
  Pairs pairs(false);
  pairs.First(200);
  pairs.First(10);
  pairs.Second(10);
  EXPECT_THAT(pairs.taken, ElementsAre(Pair(10, 10)));
}

TEST(FramePairs, OfNearestStampsWaitForALaterOne) {
  Pairs pairs(true);
  pairs.First(10);
  pairs.Second(8);
  EXPECT_TRUE(pairs.taken.empty());  // one of 9 to 12 may come
  pairs.Second(11);
  pairs.First(20);
  EXPECT_THAT(pairs.taken, ElementsAre(Pair(10, 11)));
  pairs.Second(20);
  EXPECT_THAT(pairs.taken, ElementsAre(Pair(10, 11), Pair(20, 20)));
}

TEST(FramePairs, OfNearestStampsUseAMessageOnce) {
  Pairs pairs(true);
  for (const int stamp : {10, 14, 18, 22}) pairs.First(stamp);
  for (const int stamp : {15, 23}) pairs.Second(stamp);
  EXPECT_THAT(pairs.taken, ElementsAre(Pair(14, 15)));
}

}  // namespace
}  // namespace plumbline::ros_node
