// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_uncertainty.h"

#include "plumbline/base/random.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(SigmaOfPose, IsTheWorstDeviationOfEachHalf) {
  Vector6d sigma;
  sigma << 0.001, 0.003, 0.002, 0.04, 0.02, 0.08;
  const Matrix6d information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const PoseUncertainty result = SigmaOfPose(information, 4);
  EXPECT_NEAR(result.rotation, 0.003, 1e-12);
  EXPECT_NEAR(result.translation, 0.08 / 4, 1e-12);
  EXPECT_TRUE(result.AtMost(0.021));
  EXPECT_FALSE(result.AtMost(0.019));
}

// What the other degrees of freedom take away counts: a turn that looks like a shift.
TEST(SigmaOfPose, IsMarginal) {
  Matrix6d information = 100 * Matrix6d::Identity();
  information(1, 3) = information(3, 1) = 99;
  const double variance = information.inverse()(1, 1);
  EXPECT_NEAR(SigmaOfPose(information, 1).rotation, std::sqrt(variance), 1e-9);
  EXPECT_GT(std::sqrt(variance), 0.5);  // 0.1 without the correlation
}

TEST(SigmaOfPose, IsInfiniteWhereADirectionIsOpenOrThereIsNoScene) {
  Matrix6d information = 100 * Matrix6d::Identity();
  EXPECT_TRUE(std::isinf(SigmaOfPose(information, 0).rotation));
  information(4, 4) = 0;
  EXPECT_TRUE(std::isinf(SigmaOfPose(information, 1).translation));
  EXPECT_FALSE(SigmaOfPose(information, 1).AtMost(1e9));
}

// Two stereo cameras; the second sees only the first `seen` of the lines. The first lines are
// vertical, one beside the other.
BaProblem TwoViewsOfLines(int seen) {
  BaProblem problem;
  problem.camera = {.fx = 400, .fy = 400, .cx = 320, .cy = 240, .width = 640, .height = 480};
  problem.camera.baseline = 0.1;
  problem.poses = {{Rigid3{}}, {ExpSe3((Vector6d() << 0, 0.02, 0, 0.1, 0, 0.1).finished())}};
  Rng rng(1, "lines", 0);
  for (int i = 0; i < 24; ++i) {
    const Eigen::Vector3d start(-1.2 + 0.1 * i, -0.5, 4 + 0.05 * i);
    const Eigen::Vector3d along =
        i < 8 ? Eigen::Vector3d(0, 1, 0)
              : Eigen::Vector3d(rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-1, 1));
    problem.lines.push_back(ToOrthonormal(LineThroughPoints(start, start + along)));
    for (int pose = 0; pose < 2; ++pose) {
      if (pose == 1 && i >= seen) continue;
      const Rigid3& cam = problem.poses[static_cast<std::size_t>(pose)].cam_from_world;
      const auto px = [&](const Eigen::Vector3d& p, double shift) -> Eigen::Vector2d {
        return problem.camera.Project(cam * p - Eigen::Vector3d(shift, 0, 0));
      };
      for (const double shift : {0.0, 0.1}) {
        problem.line_observations.push_back({pose,
                                             i,
                                             {{px(start, shift), px(start + along, shift)},
                                              0.25 * Eigen::Matrix2d::Identity(),
                                              shift > 0}});
      }
    }
  }
  return problem;
}

void AddPoseLikeTheSecond(BaProblem& problem) {
  const int added = static_cast<int>(problem.poses.size());
  problem.poses.push_back(problem.poses[1]);
  const auto observations = problem.line_observations;
  for (auto o : observations) {
    if (o.pose != 1) continue;
    o.pose = added;
    problem.line_observations.push_back(o);
  }
}

bool HoldLoose(const BaResult& state, double limit, BaProblem& problem) {
  return FixUnconstrainedPoses(SigmasOfPoses(problem, state), limit, problem);
}

bool HoldTorn(const BaResult& solution, const PoseLimits& limits, BaProblem& problem) {
  return FixInconsistentPoses(solution, SigmasOfPoses(problem, solution), limits, problem);
}

TEST(FixUnconstrainedPoses, HoldsThePoseThatParallelLinesLeaveOpen) {
  BaProblem all = TwoViewsOfLines(24);
  EXPECT_FALSE(HoldLoose(InitialState(all), 0.01, all));
  EXPECT_FALSE(all.poses[0].fixed || all.poses[1].fixed);

  BaProblem parallel = TwoViewsOfLines(8);
  EXPECT_TRUE(HoldLoose(InitialState(parallel), 0.01, parallel));
  EXPECT_FALSE(parallel.poses[0].fixed);
  EXPECT_TRUE(parallel.poses[1].fixed);
  EXPECT_FALSE(HoldLoose(InitialState(parallel), 0.01, parallel)) << "held already";
}

TEST(FixUnconstrainedPoses, CountsInliersOnly) {
  BaProblem problem = TwoViewsOfLines(24);
  BaResult state = InitialState(problem);
  for (std::size_t k = 0; k < problem.line_observations.size(); ++k) {
    const auto& o = problem.line_observations[k];
    if (o.pose == 1 && o.line >= 8) state.line_inliers[k] = false;
  }
  EXPECT_TRUE(HoldLoose(state, 0.01, problem));
  EXPECT_TRUE(problem.poses[1].fixed);
}

TEST(SolveWithPoseLimits, MovesWhatIsFixedAndNothingElse) {
  const auto solve = [](int seen, BaProblem& problem) {
    problem = TwoViewsOfLines(seen);
    problem.poses[0].fixed = true;
    Rigid3& pose = problem.poses[1].cam_from_world;
    pose = ExpSe3(Vector6d::Constant(0.003)) * pose;
    constexpr PoseLimits kNoTears{.sigma = 0.01, .change = 1e3};
    return SolveWithPoseLimits(problem, {}, SolveLocalBa, kNoTears).value();
  };
  BaProblem problem;
  const BaResult all = solve(24, problem);
  const Rigid3 truth = TwoViewsOfLines(24).poses[1].cam_from_world;
  EXPECT_LT(LogSe3(all.poses[1] * Inverse(truth)).norm(), 1e-4);
  EXPECT_FALSE(problem.poses[1].fixed);
  const BaResult parallel = solve(8, problem);
  EXPECT_TRUE(problem.poses[1].fixed);
  EXPECT_EQ(parallel.poses[1].translation, problem.poses[1].cam_from_world.translation);
}

constexpr PoseLimits kLimits{.sigma = 0.02, .change = 0.01};

// Five poses; the solution takes the last two somewhere else together.
TEST(FixInconsistentPoses, HoldsBothSidesOfATear) {
  BaProblem problem = TwoViewsOfLines(24);
  for (int i = 0; i < 3; ++i) AddPoseLikeTheSecond(problem);
  const auto held = [&](double slide) {
    BaProblem copy = problem;
    BaResult solution = InitialState(problem);
    for (std::size_t i = 3; i < 5; ++i) solution.poses[i].translation.z() += slide;
    const bool any = HoldTorn(solution, kLimits, copy);
    EXPECT_EQ(HoldTorn(solution, kLimits, copy), false) << "held already";
    std::vector<int> fixed;
    for (std::size_t i = 0; i < 5; ++i) {
      if (copy.poses[i].fixed) fixed.push_back(static_cast<int>(i));
    }
    EXPECT_EQ(any, !fixed.empty());
    return fixed;
  };
  const double depth = SigmasOfPoses(problem, InitialState(problem))[3].scene_depth;
  EXPECT_NEAR(depth, 4.7, 0.5);
  EXPECT_EQ(held(0.009 * depth), std::vector<int>{});
  EXPECT_EQ(held(0.011 * depth), (std::vector<int>{2, 3}));
  BaResult turned = InitialState(problem);
  turned.poses[4] = ExpSe3((Vector6d() << 0, 0, 0.011, 0, 0, 0).finished()) * turned.poses[4];
  EXPECT_TRUE(HoldTorn(turned, kLimits, problem));
  EXPECT_TRUE(problem.poses[3].fixed && problem.poses[4].fixed);
}

// The third pose has too little of its own, and stays behind while its neighbours are corrected.
TEST(FixInconsistentPoses, PassesOverLoosePoses) {
  BaProblem problem = TwoViewsOfLines(24);
  problem.poses.push_back(problem.poses[1]);
  AddPoseLikeTheSecond(problem);
  ASSERT_TRUE(HoldLoose(InitialState(problem), 0.01, problem));
  ASSERT_TRUE(problem.poses[2].fixed);
  BaResult solution = InitialState(problem);
  for (const std::size_t i : {0UL, 1UL, 3UL}) solution.poses[i].translation.z() += 0.5;
  EXPECT_FALSE(HoldTorn(solution, kLimits, problem));
  solution.poses[3].translation.z() += 0.5;
  EXPECT_TRUE(HoldTorn(solution, kLimits, problem));
  EXPECT_TRUE(problem.poses[1].fixed && problem.poses[3].fixed) << "across the loose one";
  EXPECT_FALSE(problem.poses[0].fixed);
}

TEST(SolveWithPoseLimits, HoldsWhatASolutionTearsApart) {
  const Rigid3 truth = TwoViewsOfLines(24).poses[1].cam_from_world;
  const auto moved_by = [&](double turn) {
    BaProblem problem = TwoViewsOfLines(24);
    problem.poses[0].fixed = true;
    problem.poses[1].cam_from_world.rotation = ExpSo3(Eigen::Vector3d(0, turn, 0)) * truth.rotation;
    const Rigid3 before = problem.poses[1].cam_from_world;
    int solutions = 0;
    const auto solution =
        SolveWithPoseLimits(problem, {}, SolveLocalBa, kLimits, [&](BaResult&) { ++solutions; });
    if (!solution) return std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(solutions, problem.poses[1].fixed ? 2 : 1);
    return LogSe3(solution->poses[1] * Inverse(before)).norm();
  };
  EXPECT_NEAR(moved_by(0.004), 0.004, 1e-3);
  EXPECT_EQ(moved_by(0.04), 0);
}

TEST(SolveWithPoseLimits, HasNoSolutionWhenItIsStopped) {
  for (const int questions : {0, 1}) {
    BaProblem problem = TwoViewsOfLines(24);
    problem.poses[0].fixed = true;
    problem.poses[1].cam_from_world.translation.x() += 0.01;
    int asked = 0;
    EXPECT_FALSE(SolveWithPoseLimits(problem, {}, SolveLocalBa, kLimits, {}, [&] {
      return asked++ >= questions;
    })) << questions;
  }
}

// However often something tears: the last time all poses are held.
TEST(SolveWithPoseLimits, ComesToAnEnd) {
  BaProblem problem = TwoViewsOfLines(24);
  for (int i = 0; i < 8; ++i) AddPoseLikeTheSecond(problem);
  std::size_t solutions = 0;
  const auto tear_another = [&](BaResult& result) {
    result.poses[2 * solutions].translation.z() += 10;
    ++solutions;
  };
  const auto solution = SolveWithPoseLimits(problem, {}, SolveLocalBa, kLimits, tear_another);
  ASSERT_TRUE(solution.has_value());
  EXPECT_LE(solutions, 4U);
  EXPECT_GE(solutions, 3U);
  for (const auto& pose : problem.poses) EXPECT_TRUE(pose.fixed);
}

// A window has keyframes of long ago beside new ones: what is corrected between them is no tear.
TEST(FixInconsistentPoses, AsksOnlyThoseThatFollow) {
  BaProblem problem = TwoViewsOfLines(24);
  AddPoseLikeTheSecond(problem);
  BaResult solution = InitialState(problem);
  solution.poses[2].translation.z() += 0.5;
  problem.poses[2].follows = false;
  EXPECT_FALSE(HoldTorn(solution, kLimits, problem));
  problem.poses[2].follows = true;
  EXPECT_TRUE(HoldTorn(solution, kLimits, problem));
}

TEST(SigmasOfPoses, ShrinkWithTheNumberOfObservations) {
  const BaProblem few = TwoViewsOfLines(14);
  const BaProblem many = TwoViewsOfLines(24);
  const PoseUncertainty a = SigmasOfPoses(few, InitialState(few))[1];
  const PoseUncertainty b = SigmasOfPoses(many, InitialState(many))[1];
  EXPECT_LT(b.rotation, a.rotation);
  EXPECT_LT(b.translation, a.translation);
}

}  // namespace
}  // namespace plumbline
