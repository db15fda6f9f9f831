// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/pairwise_consistency.h"

#include "tests/loop_closing/loop_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::vector<std::vector<bool>> Joined(std::size_t count,
                                      const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::vector<bool>> joined(count, std::vector<bool>(count, false));
  for (const auto& [a, b] : pairs) {
    joined[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = true;
    joined[static_cast<std::size_t>(b)][static_cast<std::size_t>(a)] = true;
  }
  return joined;
}

TEST(LargestConsistentSet, FindsTheLargestClique) {
  EXPECT_EQ(LargestConsistentSet(Joined(6, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {2, 4}, {4, 5}})),
            (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(LargestConsistentSet(Joined(3, {})), std::vector<int>{0});
  EXPECT_TRUE(LargestConsistentSet({}).empty());
}

TEST(LargestConsistentSet, TakesTheFirstOfSeveral) {
  EXPECT_EQ(LargestConsistentSet(Joined(4, {{2, 3}, {0, 1}})), (std::vector<int>{0, 1}));
}

TEST(CycleChi2, TellsLoopsThatContradictEachOther) {
  const auto scene = testing::MakeLoopScene({});
  const EssentialGraph essential = MakeEssentialGraph(scene.map, false, {}, 60);
  const auto loop = [&](int query, int candidate, double error) {
    PoseGraphEdge edge;
    edge.to = candidate;
    edge.from = query;
    edge.to_from = essential.poses[static_cast<std::size_t>(candidate)] *
                   Inverse(essential.poses[static_cast<std::size_t>(query)]);
    edge.to_from.translation.y() += error;
    edge.information.diagonal().head<6>().setConstant(1e4);
    return edge;
  };
  OdometryWays odometry(essential);
  EXPECT_LT(CycleChi2(odometry, loop(44, 4, 0), loop(42, 2, 0)), 1e-9);
  EXPECT_GT(CycleChi2(odometry, loop(44, 4, 1), loop(42, 2, 0)), 50);
  // Both wrong alike: they do not contradict each other.
  EXPECT_LT(CycleChi2(odometry, loop(44, 4, 1), loop(43, 3, 1)), 24);
}

}  // namespace
}  // namespace plumbline
