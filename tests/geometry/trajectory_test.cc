// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/trajectory.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr std::int64_t kMs = 1000000;

Trajectory ThreePoses() {
  return {{100 * kMs, {Eigen::Quaterniond::Identity(), {0, 0, 0}}},
          {200 * kMs, {ExpSo3({0, 0, 0.4}), {1, 0, 0}}},
          {500 * kMs, {ExpSo3({0, 0, 0.4}), {1, 2, 0}}}};
}

TEST(InterpolateAt, IsLinearBetweenNeighbours) {
  const auto pose = InterpolateAt(ThreePoses(), 125 * kMs, 100 * kMs);
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->translation - Eigen::Vector3d(0.25, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(LogSo3(pose->rotation).z(), 0.1, 1e-12);
}

TEST(InterpolateAt, AnswersItsOwnStampsWhateverTheGap) {
  const Trajectory trajectory = ThreePoses();
  for (const StampedPose& sample : trajectory) {
    const auto pose = InterpolateAt(trajectory, sample.stamp_ns, 0);
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->translation, sample.world_from_camera.translation);
  }
}

TEST(InterpolateAt, LeavesGapsAndTheOutsideOpen) {
  const Trajectory trajectory = ThreePoses();
  EXPECT_FALSE(InterpolateAt(trajectory, 300 * kMs, 299 * kMs));
  EXPECT_TRUE(InterpolateAt(trajectory, 300 * kMs, 300 * kMs));
  EXPECT_FALSE(InterpolateAt(trajectory, 100 * kMs - 1, 300 * kMs));
  EXPECT_FALSE(InterpolateAt(trajectory, 500 * kMs + 1, 300 * kMs));
  EXPECT_FALSE(InterpolateAt({}, 0, 300 * kMs));
}

TEST(InterpolateAt, KeepsNanosecondsOfLargeStamps) {
  const std::int64_t t0 = 1403636584763555584;
  const Trajectory trajectory = {{t0, {}}, {t0 + 2, {Eigen::Quaterniond::Identity(), {2, 0, 0}}}};
  EXPECT_DOUBLE_EQ(InterpolateAt(trajectory, t0 + 1, 10)->translation.x(), 1);
}

TEST(NearestIndex, PicksTheNearestWithinTheLimit) {
  const Trajectory trajectory = ThreePoses();
  EXPECT_EQ(NearestIndex(trajectory, 149 * kMs, 100 * kMs), 0U);
  EXPECT_EQ(NearestIndex(trajectory, 150 * kMs, 100 * kMs), 0U);
  EXPECT_EQ(NearestIndex(trajectory, 151 * kMs, 100 * kMs), 1U);
  EXPECT_EQ(NearestIndex(trajectory, 90 * kMs, 10 * kMs), 0U);
  EXPECT_EQ(NearestIndex(trajectory, 511 * kMs, 11 * kMs), 2U);
  EXPECT_EQ(NearestIndex(trajectory, 511 * kMs, 10 * kMs), std::nullopt);
  EXPECT_EQ(NearestIndex({}, 0, 10 * kMs), std::nullopt);
}

TEST(PathLength, SumsTheSteps) {
  EXPECT_DOUBLE_EQ(PathLength(ThreePoses()), 3);
  EXPECT_EQ(PathLength({}), 0);
}

TEST(TimeReversed, MirrorsStampsAndKeepsEachPoseWithItsStamp) {
  const Trajectory reversed = TimeReversed(ThreePoses(), 600 * kMs);
  ASSERT_EQ(reversed.size(), 3U);
  EXPECT_EQ(reversed[0].stamp_ns, 100 * kMs);
  EXPECT_EQ(reversed[1].stamp_ns, 400 * kMs);
  EXPECT_EQ(reversed[2].stamp_ns, 500 * kMs);
  EXPECT_EQ(reversed[0].world_from_camera.translation, Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(reversed[1].world_from_camera.translation, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(reversed[2].world_from_camera.translation, Eigen::Vector3d(0, 0, 0));
}

TEST(TimeReversed, TwiceIsTheTrajectoryItself) {
  const Trajectory trajectory = ThreePoses();
  const Trajectory twice = TimeReversed(TimeReversed(trajectory, 17), 17);
  ASSERT_EQ(twice.size(), trajectory.size());
  for (std::size_t i = 0; i < twice.size(); ++i) {
    EXPECT_EQ(twice[i].stamp_ns, trajectory[i].stamp_ns);
    EXPECT_EQ(twice[i].world_from_camera.translation, trajectory[i].world_from_camera.translation);
  }
  EXPECT_TRUE(TimeReversed({}, 17).empty());
}

}  // namespace
}  // namespace plumbline
