// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/local_ba.h"

#include "plumbline/base/error.h"
#include "plumbline/optimization/line_ends.h"
#include "plumbline/optimization/projected_ends.h"

#include "tests/optimization/ba_scene.h"
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

static_assert(OptionGroup<LocalBaOptions>);

using testing::BaScene;
using testing::MakeBaScene;

double Error(const Rigid3& a, const Rigid3& b) { return LogSe3(a * Inverse(b)).norm(); }

double LargestPoseError(const BaResult& result, const BaProblem& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    largest = std::max(largest, Error(result.poses[i], truth.poses[i].cam_from_world));
  }
  return largest;
}

// With 1 px of noise, the pose farthest from the fixed ones drifts by some centimetres; the start
// is 15 cm off.
constexpr double kDrift = 0.06;

// Exactly the same numbers.
void ExpectSame(const Rigid3& a, const Rigid3& b) {
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
  EXPECT_EQ(a.translation, b.translation);
}

class SolveLocalBaWithLines
    : public ::testing::TestWithParam<std::tuple<LineParametrization, LineResidualKind>> {
 protected:
  static LineParametrization Lines() { return std::get<0>(GetParam()); }
  static LineResidualKind Residual() { return std::get<1>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Parametrizations,
                         SolveLocalBaWithLines,
                         ::testing::Combine(::testing::Values(LineParametrization::kPlucker,
                                                              LineParametrization::kPluckerLeft,
                                                              LineParametrization::kEndpoints),
                                            ::testing::Values(LineResidualKind::kObservedEnds,
                                                              LineResidualKind::kProjectedEnds)));

TEST_P(SolveLocalBaWithLines, RecoversTheExactSceneWithoutNoise) {
  BaScene scene = MakeBaScene(1, {});
  scene.problem.line_residual = Residual();
  const BaResult result =
      SolveLocalBa(scene.problem, {.max_iterations = 50, .function_tolerance = 1e-12}, Lines());
  EXPECT_LT(LargestPoseError(result, scene.truth), 1e-9);
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    EXPECT_LT((result.points[i] - scene.truth.points[i]).norm(), 1e-8) << i;
  }
  for (std::size_t i = 0; i < result.lines.size(); ++i) {
    const PluckerLine line = ToPlucker(result.lines[i]);
    const PluckerLine truth = ToPlucker(scene.truth.lines[i]);
    EXPECT_LT((line.moment - truth.moment).norm(), 1e-7) << i;
    EXPECT_LT((line.direction - truth.direction).norm(), 1e-8) << i;
  }
  EXPECT_EQ(std::count(result.point_inliers.begin(), result.point_inliers.end(), false), 0);
  EXPECT_EQ(std::count(result.line_inliers.begin(), result.line_inliers.end(), false), 0);
}

TEST_P(SolveLocalBaWithLines, GivesTheSameBytesEveryTime) {
  BaScene scene = MakeBaScene(15, {.weak_lines = 20, .sigma = 1, .outliers = 0.05});
  scene.problem.line_residual = Residual();
  const BaResult a = SolveLocalBa(scene.problem, {}, Lines());
  const BaResult b = SolveLocalBa(scene.problem, {}, Lines());
  for (std::size_t i = 0; i < a.poses.size(); ++i) ExpectSame(a.poses[i], b.poses[i]);
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].U.coeffs(), b.lines[i].U.coeffs());
    EXPECT_EQ(a.lines[i].w, b.lines[i].w);
  }
  EXPECT_EQ(a.final_cost, b.final_cost);
}

// Told to end at its n-th question, it has the state of the steps until then.
TEST_P(SolveLocalBaWithLines, EndsWhenItIsTold) {
  BaScene scene = MakeBaScene(15, {.sigma = 1, .outliers = 0.05});
  scene.problem.line_residual = Residual();
  const BaResult whole = SolveLocalBa(scene.problem, {}, Lines(), [] { return false; });
  EXPECT_NE(whole.termination, BaTermination::kStopped);
  EXPECT_EQ(whole.final_cost, SolveLocalBa(scene.problem, {}, Lines()).final_cost);
  for (const int questions : {0, 1, 2, 3}) {
    int asked = 0;
    const BaResult result =
        SolveLocalBa(scene.problem, {}, Lines(), [&] { return asked++ >= questions; });
    EXPECT_EQ(result.termination, BaTermination::kStopped) << questions;
    EXPECT_LE(result.iterations, questions);
    EXPECT_LE(result.final_cost, result.initial_cost);
    ASSERT_EQ(result.poses.size(), scene.problem.poses.size());
    EXPECT_EQ(result.point_inliers.size(), scene.problem.point_observations.size());
    if (questions > 0) continue;
    for (std::size_t i = 0; i < result.poses.size(); ++i) {
      ExpectSame(result.poses[i], scene.problem.poses[i].cam_from_world);
    }
  }
}

TEST_P(SolveLocalBaWithLines, LinesWithoutObservationsStayBitByBit) {
  BaScene scene = MakeBaScene(16, {.points = 100, .lines = 20, .sigma = 1});
  scene.problem.lines.push_back(ToOrthonormal(LineThroughPoints({1, 1, 1}, {2, 1.5, 1})));
  scene.problem.line_residual = Residual();
  const BaResult result = SolveLocalBa(scene.problem, {}, Lines());
  EXPECT_EQ(result.lines.back().U.coeffs(), scene.problem.lines.back().U.coeffs());
  EXPECT_EQ(result.lines.back().w, scene.problem.lines.back().w);
}

TEST(SolveLocalBa, BothTurnsOfPluckerLinesReachTheSameMinimum) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.sigma = 1, .outliers = 0.05});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 200, .function_tolerance = 1e-13};
    const BaResult own = SolveLocalBa(scene.problem, options, LineParametrization::kPlucker);
    const BaResult left = SolveLocalBa(scene.problem, options, LineParametrization::kPluckerLeft);
    EXPECT_NEAR(left.final_cost, own.final_cost, 1e-6 * own.final_cost) << seed;
    for (std::size_t i = 0; i < left.poses.size(); ++i) {
      EXPECT_LT(Error(left.poses[i], own.poses[i]), 1e-4) << seed;
    }
  }
}

// With the covariance that follows for them, the residuals of the projected ends are those of the
// observed ends under an invertible linear map, to first order: the same answer.
TEST(SolveLocalBa, ProjectedEndsWithTheirCovarianceFindTheSamePoses) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    // The ends are placed once, at the start: near the answer they are where they should be.
    const BaScene scene = MakeBaScene(seed, {.sigma = 0.05, .perturbation = 0.02});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 100, .function_tolerance = 1e-10};
    BaProblem projected = scene.problem;
    projected.line_residual = LineResidualKind::kProjectedEnds;
    const std::vector<Segment3> ends = TrimmedEnds(scene.problem);
    for (auto& o : projected.line_observations) {
      o.measurement.covariance = ProjectedEndsCovariance(
          projected.camera,
          scene.truth.poses[static_cast<std::size_t>(o.pose)].cam_from_world,
          ends[static_cast<std::size_t>(o.line)],
          o.measurement);
    }
    const BaResult a = SolveLocalBa(scene.problem, options);
    const BaResult b = SolveLocalBa(projected, options);
    const double far = LargestPoseError(a, scene.truth);
    for (std::size_t i = 0; i < a.poses.size(); ++i) {
      EXPECT_LT(Error(a.poses[i], b.poses[i]), 0.15 * far) << seed;
    }
  }
}

TEST(SolveLocalBa, EndPointsReachTheMinimumOfPluckerLines) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.sigma = 1, .outliers = 0.05});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 200, .function_tolerance = 1e-13};
    const BaResult plucker = SolveLocalBa(scene.problem, options, LineParametrization::kPlucker);
    const BaResult ends = SolveLocalBa(scene.problem, options, LineParametrization::kEndpoints);
    EXPECT_NEAR(ends.initial_cost, plucker.initial_cost, 1e-9 * plucker.initial_cost);
    EXPECT_NEAR(ends.final_cost, plucker.final_cost, 1e-6 * plucker.final_cost) << seed;
    for (std::size_t i = 0; i < ends.poses.size(); ++i) {
      EXPECT_LT(Error(ends.poses[i], plucker.poses[i]), 1e-4) << seed;
    }
    for (std::size_t i = 0; i < ends.lines.size(); ++i) {  // also the same direction along the line
      const PluckerLine a = ToPlucker(ends.lines[i]);
      const PluckerLine b = ToPlucker(plucker.lines[i]);
      EXPECT_GT(a.direction.dot(b.direction), 0.99) << seed << " " << i;
    }
  }
}

// Per line two states, its measurements, and a 6 x 4 or 6 x 6 block for each free pose that sees
// it.
TEST(SolveLocalBa, TellsTheMemoryOfLines) {
  const auto bytes = [](int points, int lines, LineParametrization parametrization) {
    const BaScene scene = MakeBaScene(1, {.points = points, .lines = lines, .sigma = 1});
    return SolveLocalBa(scene.problem, {.rounds = 1}, parametrization).line_bytes;
  };
  const std::size_t plucker = bytes(50, 80, LineParametrization::kPlucker);
  const BaProblem problem = MakeBaScene(1, {.points = 50, .lines = 80, .sigma = 1}).problem;
  const std::size_t measurements = problem.line_observations.size();
  const auto& poses = problem.poses;
  std::set<std::pair<int, int>> free_views;
  for (const auto& o : problem.line_observations) {
    if (!poses[static_cast<std::size_t>(o.pose)].fixed) free_views.insert({o.line, o.pose});
  }
  constexpr std::size_t kBlock = 6 * 4 * sizeof(double);
  EXPECT_GT(plucker,
            80 * 2 * sizeof(OrthonormalLine) + measurements * sizeof(LineMeasurement) / 2 +
                free_views.size() * kBlock);
  EXPECT_GE(bytes(50, 80, LineParametrization::kEndpoints),
            plucker + free_views.size() * kBlock / 2);
  EXPECT_EQ(bytes(0, 80, LineParametrization::kPlucker), plucker);  // without those of points
}

// The free sliding of the ends must not cost iterations.
TEST(SolveLocalBa, EndPointsConvergeInAboutAsManyIterationsAsPluckerLines) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.weak_lines = 80, .sigma = 1, .outliers = 0.05});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 100};
    const BaResult plucker = SolveLocalBa(scene.problem, options, LineParametrization::kPlucker);
    const BaResult ends = SolveLocalBa(scene.problem, options, LineParametrization::kEndpoints);
    EXPECT_EQ(ends.termination, BaTermination::kConverged) << seed;
    EXPECT_LE(ends.iterations, 2 * plucker.iterations) << seed;
    EXPECT_LT(ends.final_cost, 1.01 * plucker.final_cost) << seed;
  }
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

double LineAngle(const OrthonormalLine& a, const OrthonormalLine& b) {
  return ToPlucker(a).direction.cross(ToPlucker(b).direction).norm();
}

TEST(SolveLocalBa, HoldsLinesParallelToTheirAxes) {
  for (const auto parametrization : {LineParametrization::kPlucker,
                                     LineParametrization::kPluckerLeft,
                                     LineParametrization::kEndpoints}) {
    BaScene scene = MakeBaScene(31, {.sigma = 1});
    const BaResult without = SolveLocalBa(scene.problem, {}, parametrization);
    for (std::size_t i = 0; i < scene.truth.lines.size(); ++i) {
      const double sense = i % 2 == 0 ? 1 : -1;
      scene.problem.axes.push_back(sense * ToPlucker(scene.truth.lines[i]).direction);
      scene.problem.parallel_lines.push_back({static_cast<int>(i), static_cast<int>(i), 2e-3});
    }
    const BaResult with = SolveLocalBa(scene.problem, {}, parametrization);
    EXPECT_EQ(with.poses.size(), scene.problem.poses.size());
    EXPECT_EQ(with.line_inliers.size(), scene.problem.line_observations.size());
    EXPECT_EQ(with.line_chi2.size(), scene.problem.line_observations.size());
    double error_without = 0;
    double error_with = 0;
    for (std::size_t i = 0; i < scene.truth.lines.size(); ++i) {
      error_without += LineAngle(without.lines[i], scene.truth.lines[i]);
      error_with += LineAngle(with.lines[i], scene.truth.lines[i]);
    }
    EXPECT_LT(error_with, 0.5 * error_without);
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
