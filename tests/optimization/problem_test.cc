// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/problem.h"

#include "plumbline/base/error.h"

#include "tests/optimization/ba_scene.h"
#include "tests/optimization/block_patterns.h"
#include <array>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

BaProblem SmallProblem() { return testing::MakeBaScene(14, {.points = 3, .lines = 3}).problem; }

TEST(CheckIndices, RefusesObservationsOfWhatIsNotThere) {
  EXPECT_NO_THROW(CheckIndices(SmallProblem()));
  BaProblem problem = SmallProblem();
  problem.point_observations[0].point = 3;
  EXPECT_THROW(CheckIndices(problem), BugError);
  problem = SmallProblem();
  problem.line_observations[0].pose = static_cast<int>(problem.poses.size());
  EXPECT_THROW(CheckIndices(problem), BugError);
  problem = SmallProblem();
  problem.line_observations[0].line = -1;
  EXPECT_THROW(CheckIndices(problem), BugError);
}

TEST(CheckIndices, RefusesEndsOfOnlySomeLines) {
  BaProblem problem = SmallProblem();
  problem.line_ends.resize(problem.lines.size());
  EXPECT_NO_THROW(CheckIndices(problem));
  problem.line_ends.pop_back();
  EXPECT_THROW(CheckIndices(problem), BugError);
}

TEST(CheckIndices, RefusesAxesThatCannotBeUsed) {
  BaProblem problem = SmallProblem();
  problem.axes = {Eigen::Vector3d::UnitY()};
  problem.parallel_lines = {{0, 0, 0.01}};
  EXPECT_NO_THROW(CheckIndices(problem));
  problem.parallel_lines = {{1, 0, 0.01}};
  EXPECT_THROW(CheckIndices(problem), BugError);
  problem.parallel_lines = {{0, 0, 0}};
  EXPECT_THROW(CheckIndices(problem), BugError);
}

TEST(IsFinite, LooksAtPosesLandmarksAndMeasurements) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(IsFinite(SmallProblem()));
  BaProblem problem = SmallProblem();
  problem.poses[1].cam_from_world.translation.y() = kNan;
  EXPECT_FALSE(IsFinite(problem));
  problem = SmallProblem();
  problem.points[2].x() = kNan;
  EXPECT_FALSE(IsFinite(problem));
  problem = SmallProblem();
  problem.lines[0].w.x() = kNan;
  EXPECT_FALSE(IsFinite(problem));
  problem = SmallProblem();
  problem.line_ends = {{Eigen::Vector3d::Constant(kNan), Eigen::Vector3d::Zero()}};
  EXPECT_FALSE(IsFinite(problem));
  problem = SmallProblem();
  problem.point_observations[0].measurement.disparity = Disparity{1, kNan};
  EXPECT_FALSE(IsFinite(problem));
  problem = SmallProblem();
  problem.line_observations[0].measurement.covariance(0, 1) = kNan;
  EXPECT_FALSE(IsFinite(problem));
}

}  // namespace

namespace sharing_poses_test {

// Points and lines that random poses show, some of them twice.
BaProblem RandomSightings(unsigned seed, int poses, int landmarks, int observations) {
  testing::Random random(seed);
  BaProblem problem;
  problem.poses.resize(static_cast<std::size_t>(poses));
  problem.points.resize(static_cast<std::size_t>(landmarks));
  problem.lines.resize(static_cast<std::size_t>(landmarks));
  for (int i = 0; i < observations; ++i) {
    const int pose = random.Index(poses);
    problem.point_observations.push_back({pose, random.Index(landmarks), {}});
  }
  for (int i = 0; i < observations; ++i) {
    const int pose = random.Index(poses);
    problem.line_observations.push_back({pose, random.Index(landmarks), {}});
  }
  return problem;
}

// Compares all observations with each other.
BlockPattern Expected(const BaProblem& problem) {
  std::set<std::pair<int, int>> pairs;
  for (const auto& a : problem.point_observations) {
    for (const auto& b : problem.point_observations) {
      if (a.point == b.point) pairs.insert({a.pose, b.pose});
    }
  }
  for (const auto& a : problem.line_observations) {
    for (const auto& b : problem.line_observations) {
      if (a.line == b.line) pairs.insert({a.pose, b.pose});
    }
  }
  return testing::PatternOf(static_cast<int>(problem.poses.size()), pairs);
}

TEST(SharingPoses, ListsEarlierPosesWithTheSameLandmark) {
  for (const auto& [poses, landmarks, observations] :
       {std::array{30, 40, 60}, std::array{30, 10, 100}, std::array{50, 400, 100}}) {
    const BaProblem problem = RandomSightings(7, poses, landmarks, observations);
    EXPECT_EQ(SharingPoses(problem), Expected(problem));
  }
  EXPECT_TRUE(SharingPoses(BaProblem()).empty());
}

TEST(SharingPoses, EndsWhenItIsStopped) {
  const BaProblem problem = RandomSightings(8, 30, 10, 200);
  int asked = 0;
  const BlockPattern pattern = SharingPoses(problem, [&] { return asked++ >= 3; });
  EXPECT_EQ(asked, 4);
  EXPECT_EQ(pattern.size(), 30U);
  EXPECT_TRUE(pattern.back().empty());
}

}  // namespace sharing_poses_test

}  // namespace plumbline
