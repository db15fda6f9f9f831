// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/bundle_adjustment.h"

#include "plumbline/base/error.h"

#include "tests/optimization/ba_properties.h"
#include "tests/optimization/ba_scene.h"
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

static_assert(OptionGroup<LocalBaOptions>);

using testing::BaScene;
using testing::Error;
using testing::ExpectSame;
using testing::LargestPoseError;
using testing::LineAngle;
using testing::MakeBaScene;

// With 1 px of noise, the pose farthest from the fixed ones drifts by some centimetres; the start
// is 15 cm off.
constexpr double kDrift = 0.06;

TEST(SolveLocalBa, RecoversTheExactSceneWithoutNoise) {
  testing::ExpectExactSceneWithoutNoise(SolveLocalBa);
}

TEST(SolveLocalBa, GivesTheSameBytesEveryTime) { testing::ExpectSameBytesEveryTime(SolveLocalBa); }

TEST(SolveLocalBa, EndsWhenItIsTold) { testing::ExpectEndWhenItIsTold(SolveLocalBa); }

TEST(SolveLocalBa, LinesWithoutObservationsStayBitByBit) {
  testing::ExpectUnseenLinesToStayBitByBit(SolveLocalBa);
}

TEST(SolveLocalBa, HoldsLinesParallelToTheirAxes) {
  testing::ExpectLinesHeldParallel(SolveLocalBa);
}

// Per line two states, its measurements, and a 6 x 4 block for each free pose that sees it.
TEST(SolveLocalBa, TellsTheMemoryOfLines) {
  const auto bytes = [](int points, int lines) {
    const BaScene scene = MakeBaScene(1, {.points = points, .lines = lines, .sigma = 1});
    return SolveLocalBa(scene.problem, {.rounds = 1}).line_bytes;
  };
  const std::size_t all = bytes(50, 80);
  const BaProblem problem = MakeBaScene(1, {.points = 50, .lines = 80, .sigma = 1}).problem;
  const std::size_t measurements = problem.line_observations.size();
  const auto& poses = problem.poses;
  std::set<std::pair<int, int>> free_views;
  for (const auto& o : problem.line_observations) {
    if (!poses[static_cast<std::size_t>(o.pose)].fixed) free_views.insert({o.line, o.pose});
  }
  constexpr std::size_t kBlock = 6 * 4 * sizeof(float);
  EXPECT_GT(all,
            80 * 2 * sizeof(OrthonormalLine) + measurements * sizeof(LineMeasurement) / 2 +
                free_views.size() * kBlock);
  // Without those of points. Without points the scene's lines are others, with other views.
  EXPECT_NEAR(
      static_cast<double>(bytes(0, 80)), static_cast<double>(all), 0.01 * static_cast<double>(all));
}

TEST(SolveLocalBa, LowersTheErrorOfANoisyScene) {
  const BaScene scene = MakeBaScene(2, {.sigma = 1});
  const BaResult result = SolveLocalBa(scene.problem);
  EXPECT_EQ(result.termination, BaTermination::kConverged);
  EXPECT_LT(result.final_cost, result.initial_cost);
  EXPECT_LT(LargestPoseError(result, scene.truth), kDrift);
}

TEST(SolveLocalBa, FlagsTenPercentOutliers) {
  const BaScene scene = MakeBaScene(3, {.sigma = 0.5, .outliers = 0.1});
  const BaResult result = SolveLocalBa(scene.problem);
  const auto check = [](const std::vector<bool>& inliers, const std::vector<bool>& outliers) {
    int caught = 0;
    int kept = 0;
    int n_outliers = 0;
    for (std::size_t i = 0; i < outliers.size(); ++i) {
      n_outliers += outliers[i];
      caught += outliers[i] && !inliers[i];
      kept += !outliers[i] && inliers[i];
    }
    EXPECT_GT(caught, 0.97 * n_outliers);
    EXPECT_GT(kept, 0.92 * (static_cast<int>(outliers.size()) - n_outliers));
  };
  check(result.point_inliers, scene.point_outlier);
  check(result.line_inliers, scene.line_outlier);
  EXPECT_LT(LargestPoseError(result, scene.truth), kDrift);
}

// Rounds that only tell outliers need not end at their minimum: the last one does. Which of the
// observations at the limit are in use may differ, the errors do not.
TEST(SolveLocalBa, RejectingRoundsMayEndEarly) {
  const LocalBaOptions full{.rounds = 4, .max_iterations = 20};
  LocalBaOptions early = full;
  early.rejection_tolerance = 1e-2;
  int iterations_of_full = 0;
  int iterations_of_early = 0;
  double error_of_full = 0;
  double error_of_early = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.sigma = 1, .outliers = 0.1});
    const BaResult a = SolveLocalBa(scene.problem, full);
    const BaResult b = SolveLocalBa(scene.problem, early);
    int differences = 0;
    for (std::size_t k = 0; k < a.point_inliers.size(); ++k) {
      differences += a.point_inliers[k] != b.point_inliers[k] ? 1 : 0;
    }
    EXPECT_LT(differences, 0.02 * static_cast<double>(a.point_inliers.size())) << seed;
    iterations_of_full += a.iterations;
    iterations_of_early += b.iterations;
    error_of_full += LargestPoseError(a, scene.truth);
    error_of_early += LargestPoseError(b, scene.truth);
  }
  EXPECT_NEAR(error_of_early / error_of_full, 1, 0.03);
  EXPECT_LT(iterations_of_early, 0.8 * iterations_of_full);
}

TEST(SolveLocalBa, FixedPosesDoNotMove) {
  const BaScene scene = MakeBaScene(4, {.sigma = 1});
  const BaResult result = SolveLocalBa(scene.problem);
  for (std::size_t i = 0; i < 5; ++i) {
    ExpectSame(result.poses[i], scene.problem.poses[i].cam_from_world);
  }
}

TEST(SolveLocalBa, WithAllPosesFixedOnlyLandmarksMove) {
  BaScene scene = MakeBaScene(5, {.free_poses = 0});
  const BaResult result =
      SolveLocalBa(scene.problem, {.max_iterations = 50, .function_tolerance = 1e-12});
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    EXPECT_LT((result.points[i] - scene.truth.points[i]).norm(), 1e-8);
  }
}

TEST(SolveLocalBa, LandmarksAndPosesWithoutObservationsStay) {
  BaScene scene = MakeBaScene(6, {.points = 100, .lines = 20, .sigma = 1});
  scene.problem.points.push_back({1, 2, 3});
  scene.problem.lines.push_back(ToOrthonormal(LineThroughPoints({1, 1, 1}, {2, 1, 1})));
  scene.problem.poses.push_back({ExpSe3(Vector6d::Constant(0.1)), false});
  const BaResult result = SolveLocalBa(scene.problem);
  EXPECT_EQ(result.termination, BaTermination::kConverged);
  EXPECT_EQ(result.points.back(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(result.lines.back().U.coeffs(), scene.problem.lines.back().U.coeffs());
  EXPECT_LT(Error(result.poses.back(), scene.problem.poses.back().cam_from_world), 1e-14);
}

// Lines seen twice from nearly the same place have directions in which they are nearly free. They
// go on creeping, but must not hold up the rest: after ten iterations the poses are done.
TEST(SolveLocalBa, DegenerateLinesDoNotSlowTheOthers) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.weak_lines = 80, .sigma = 1, .outliers = 0.05});
    const BaResult ten = SolveLocalBa(scene.problem, {.rounds = 1, .max_iterations = 10});
    const BaResult all = SolveLocalBa(scene.problem, {.rounds = 1, .max_iterations = 100});
    EXPECT_EQ(all.termination, BaTermination::kConverged) << seed;
    EXPECT_LE(all.iterations, 30) << seed;
    EXPECT_LT(ten.final_cost, 1.01 * all.final_cost) << seed;
    EXPECT_LT(LargestPoseError(ten, scene.truth), 0.08) << seed;
    for (std::size_t i = 0; i < ten.poses.size(); ++i) {
      EXPECT_LT(Error(ten.poses[i], all.poses[i]), 0.01) << seed;
    }
  }
}

TEST(SolveLocalBa, ALineSeenFromOneViewIsHarmless) {
  BaScene scene = MakeBaScene(8, {.sigma = 1});
  auto& observations = scene.problem.line_observations;
  const int kept_pose = observations.front().pose;
  std::erase_if(observations, [&](const auto& o) {
    return o.line == 0 && (o.pose != kept_pose || o.measurement.camera == 1);
  });
  const BaResult result = SolveLocalBa(scene.problem);
  EXPECT_EQ(result.termination, BaTermination::kConverged);
  EXPECT_LE(result.iterations, 16);
  EXPECT_LT(LargestPoseError(result, scene.truth), kDrift);
}

TEST(SolveLocalBa, APointBehindTheCameraIsAnOutlierAndHarmless) {
  BaScene scene = MakeBaScene(9, {.sigma = 1});
  scene.problem.points[0] =
      Inverse(scene.truth.poses[7].cam_from_world) * Eigen::Vector3d(0, 0, -9);
  const BaResult result = SolveLocalBa(scene.problem);
  EXPECT_EQ(result.termination, BaTermination::kConverged);
  for (std::size_t i = 0; i < scene.problem.point_observations.size(); ++i) {
    if (scene.problem.point_observations[i].point != 0) continue;
    EXPECT_FALSE(result.point_inliers[i]);
    EXPECT_TRUE(std::isinf(result.point_chi2[i]));
  }
  EXPECT_LT(LargestPoseError(result, scene.truth), kDrift);
}

// A point just before a camera that has to move past it by far.
TEST(SolveLocalBa, APointThatACameraMovesPastDoesNotHoldItBack) {
  BaScene scene = MakeBaScene(9, {.sigma = 1});
  constexpr std::size_t kPose = 12;
  Rigid3& start = scene.problem.poses[kPose].cam_from_world;
  start = scene.truth.poses[kPose].cam_from_world;
  start.translation.z() += 0.3;
  const int point = static_cast<int>(scene.problem.points.size());
  scene.problem.points.push_back(Inverse(start) * Eigen::Vector3d(0, 0, 0.1));
  const BaProblem& p = scene.problem;
  scene.problem.point_observations.push_back({kPose, point, {{p.camera.cx, p.camera.cy}, 1, {}}});
  LocalBaOptions options;
  options.carry_points = true;
  const BaResult result = SolveLocalBa(scene.problem, options);
  EXPECT_EQ(result.termination, BaTermination::kConverged);
  EXPECT_LE(result.iterations, 12);
  EXPECT_LT(LargestPoseError(result, scene.truth), kDrift);
}

TEST(SolveLocalBa, NotANumberInTheInputIsReportedAndChangesNothing) {
  BaScene scene = MakeBaScene(10, {.points = 20, .lines = 5});
  scene.problem.points[3].x() = std::numeric_limits<double>::quiet_NaN();
  const BaResult result = SolveLocalBa(scene.problem);
  EXPECT_EQ(result.termination, BaTermination::kNotFinite);
  ExpectSame(result.poses[9], scene.problem.poses[9].cam_from_world);
  EXPECT_EQ(result.points[4], scene.problem.points[4]);
}

TEST(SolveLocalBa, AWildStartStaysFinite) {
  const BaScene scene = MakeBaScene(11, {.sigma = 1, .perturbation = 30});
  const BaResult result = SolveLocalBa(scene.problem, {.max_iterations = 30});
  EXPECT_LE(result.final_cost, result.initial_cost * (1 + 1e-12));
  for (const auto& pose : result.poses) {
    EXPECT_TRUE(pose.rotation.coeffs().allFinite() && pose.translation.allFinite());
  }
  for (const auto& point : result.points) EXPECT_TRUE(point.allFinite());
  for (const auto& line : result.lines) {
    EXPECT_TRUE(line.U.coeffs().allFinite() && line.w.allFinite());
  }
}

TEST(SolveLocalBa, TheOrderOfObservationsDoesNotMatter) {
  const BaScene scene = MakeBaScene(12, {.sigma = 1, .outliers = 0.05});
  BaProblem reversed = scene.problem;
  std::reverse(reversed.point_observations.begin(), reversed.point_observations.end());
  const BaResult a = SolveLocalBa(scene.problem);
  const BaResult b = SolveLocalBa(reversed);
  for (std::size_t i = 0; i < a.poses.size(); ++i) ExpectSame(a.poses[i], b.poses[i]);
  for (std::size_t i = 0, n = a.point_chi2.size(); i < n; ++i) {
    EXPECT_EQ(a.point_chi2[i], b.point_chi2[n - 1 - i]);
    EXPECT_EQ(a.point_inliers[i], b.point_inliers[n - 1 - i]);
  }
}

TEST(SolveLocalBa, NothingToDoReturnsTheInput) {
  BaProblem problem = MakeBaScene(13, {.points = 3, .lines = 0}).problem;
  problem.point_observations.clear();
  const BaResult result = SolveLocalBa(problem);
  EXPECT_EQ(result.termination, BaTermination::kNothingToDo);
  EXPECT_EQ(result.iterations, 0);
  ExpectSame(result.poses[9], problem.poses[9].cam_from_world);
}

TEST(SolveLocalBa, AnIndexOutOfRangeIsABug) {
  BaProblem problem = MakeBaScene(14, {.points = 3, .lines = 0}).problem;
  problem.point_observations[0].point = 3;
  EXPECT_THROW(SolveLocalBa(problem), BugError);
}

TEST(SolveLocalBa, NormalizesRotationsThatAreOffByLittleAndRefusesOthers) {
  const BaProblem problem = MakeBaScene(14, {.points = 60, .lines = 10, .sigma = 1}).problem;
  const auto scaled = [&](double norm) {
    BaProblem off = problem;
    for (auto& pose : off.poses) pose.cam_from_world.rotation.coeffs() *= norm;
    return off;
  };
  const BaResult exact = SolveLocalBa(problem), off = SolveLocalBa(scaled(1.006));
  for (std::size_t i = 0; i < exact.poses.size(); ++i) {
    EXPECT_LT(LogSe3(off.poses[i] * Inverse(exact.poses[i])).norm(), 1e-6) << i;
    EXPECT_NEAR(off.poses[i].rotation.norm(), 1, 1e-12);
  }
  try {
    SolveLocalBa(scaled(2));
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "poses[0]: expected a quaternion of norm 1, found one of norm 2");
  }
}

TEST(SolveLocalBa, LetsGoOfALineThatIsNotParallel) {
  BaScene scene = MakeBaScene(32, {.sigma = 1});
  const BaResult without = SolveLocalBa(scene.problem);
  const Eigen::Vector3d direction = ToPlucker(scene.truth.lines[0]).direction;
  const Eigen::Vector3d across = direction.unitOrthogonal();
  scene.problem.axes = {std::cos(0.5) * direction + std::sin(0.5) * across};
  scene.problem.parallel_lines = {{0, 0, 0.02}};
  const BaResult with = SolveLocalBa(scene.problem);
  EXPECT_LT(LineAngle(with.lines[0], without.lines[0]), 2e-3);
}

}  // namespace
}  // namespace plumbline
