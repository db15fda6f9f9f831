// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/check_problem.h"

#include "plumbline/base/error.h"

#include "tests/optimization/ba_scene.h"
#include <limits>

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
}  // namespace plumbline
