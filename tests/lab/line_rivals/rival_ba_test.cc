// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/rival_ba.h"

#include "lab/line_rivals/line_ends.h"
#include "plumbline/base/error.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/tracking/projected_ends.h"

#include "tests/optimization/ba_properties.h"
#include "tests/optimization/ba_scene.h"
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::BaScene;
using testing::Error;
using testing::LargestPoseError;
using testing::MakeBaScene;

constexpr RivalLines kLeft{LineParametrization::kPluckerLeft, LineResidualKind::kObservedEnds};
constexpr RivalLines kEnds{LineParametrization::kEndpoints, LineResidualKind::kObservedEnds};
constexpr RivalLines kProjected{LineParametrization::kPlucker, LineResidualKind::kProjectedEnds};
constexpr RivalLines kProjectedLeft{LineParametrization::kPluckerLeft,
                                    LineResidualKind::kProjectedEnds};
constexpr RivalLines kProjectedPoints{LineParametrization::kEndpoints,
                                      LineResidualKind::kProjectedEnds};

class SolveRivalBaWith : public ::testing::TestWithParam<RivalLines> {
 protected:
  static auto Solver() {
    return [](const BaProblem& problem, const LocalBaOptions& options, const StopCheck& stop) {
      return SolveRivalBa(problem, options, GetParam(), stop);
    };
  }
};
INSTANTIATE_TEST_SUITE_P(
    Rivals,
    SolveRivalBaWith,
    ::testing::Values(kLeft, kEnds, kProjected, kProjectedLeft, kProjectedPoints));

TEST_P(SolveRivalBaWith, RecoversTheExactSceneWithoutNoise) {
  testing::ExpectExactSceneWithoutNoise(Solver());
}

TEST_P(SolveRivalBaWith, GivesTheSameBytesEveryTime) {
  testing::ExpectSameBytesEveryTime(Solver());
}

TEST_P(SolveRivalBaWith, EndsWhenItIsTold) { testing::ExpectEndWhenItIsTold(Solver()); }

TEST_P(SolveRivalBaWith, LinesWithoutObservationsStayBitByBit) {
  testing::ExpectUnseenLinesToStayBitByBit(Solver());
}

TEST_P(SolveRivalBaWith, HoldsLinesParallelOrSaysThatItDoesNot) {
  if (GetParam().residual == LineResidualKind::kObservedEnds) {
    testing::ExpectLinesHeldParallel(Solver());
    return;
  }
  BaProblem problem = MakeBaScene(31, {.points = 20, .lines = 5}).problem;
  problem.axes = {Eigen::Vector3d::UnitY()};
  problem.parallel_lines = {{0, 0, 0.01}};
  EXPECT_THROW(Solver()(problem, {}, {}), BugError);
}

TEST(SolveRivalBa, BothTurnsOfPluckerLinesReachTheSameMinimum) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.sigma = 1, .outliers = 0.05});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 200, .function_tolerance = 1e-13};
    const BaResult own = SolveLocalBa(scene.problem, options);
    const BaResult left = SolveRivalBa(scene.problem, options, kLeft);
    EXPECT_NEAR(left.final_cost, own.final_cost, 1e-6 * own.final_cost) << seed;
    for (std::size_t i = 0; i < left.poses.size(); ++i) {
      EXPECT_LT(Error(left.poses[i], own.poses[i]), 1e-4) << seed;
    }
  }
}

// With the covariance that follows for them, the residuals of the projected ends are those of the
// observed ends under an invertible linear map, to first order: the same answer.
TEST(SolveRivalBa, ProjectedEndsWithTheirCovarianceFindTheSamePoses) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    // The ends are placed once, at the start: near the answer they are where they should be.
    const BaScene scene = MakeBaScene(seed, {.sigma = 0.05, .perturbation = 0.02});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 100, .function_tolerance = 1e-10};
    BaProblem projected = scene.problem;
    const std::vector<Segment3> ends = TrimmedEnds(scene.problem);
    for (auto& o : projected.line_observations) {
      o.measurement.covariance = ProjectedEndsCovariance(
          projected.camera,
          scene.truth.poses[static_cast<std::size_t>(o.pose)].cam_from_world,
          ends[static_cast<std::size_t>(o.line)],
          o.measurement);
    }
    const BaResult a = SolveLocalBa(scene.problem, options);
    const BaResult b = SolveRivalBa(projected, options, kProjected);
    const double far = LargestPoseError(a, scene.truth);
    for (std::size_t i = 0; i < a.poses.size(); ++i) {
      EXPECT_LT(Error(a.poses[i], b.poses[i]), 0.15 * far) << seed;
    }
  }
}

TEST(SolveRivalBa, EndPointsReachTheMinimumOfPluckerLines) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.sigma = 1, .outliers = 0.05});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 200, .function_tolerance = 1e-13};
    const BaResult plucker = SolveLocalBa(scene.problem, options);
    const BaResult ends = SolveRivalBa(scene.problem, options, kEnds);
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

// A 6 x 6 block in place of one of 6 x 4 for each free pose that sees a line.
TEST(SolveRivalBa, EndPointsTakeMoreMemoryThanPluckerLines) {
  const BaProblem problem = MakeBaScene(1, {.points = 50, .lines = 80, .sigma = 1}).problem;
  std::set<std::pair<int, int>> free_views;
  for (const auto& o : problem.line_observations) {
    if (!problem.poses[static_cast<std::size_t>(o.pose)].fixed) {
      free_views.insert({o.line, o.pose});
    }
  }
  constexpr std::size_t kMore = 6 * 2 * sizeof(double);
  EXPECT_GE(SolveRivalBa(problem, {.rounds = 1}, kEnds).line_bytes,
            SolveLocalBa(problem, {.rounds = 1}).line_bytes + free_views.size() * kMore);
}

// The free sliding of the ends must not cost iterations.
TEST(SolveRivalBa, EndPointsConvergeInAboutAsManyIterationsAsPluckerLines) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const BaScene scene = MakeBaScene(seed, {.weak_lines = 80, .sigma = 1, .outliers = 0.05});
    const LocalBaOptions options{.rounds = 1, .max_iterations = 100};
    const BaResult plucker = SolveLocalBa(scene.problem, options);
    const BaResult ends = SolveRivalBa(scene.problem, options, kEnds);
    EXPECT_EQ(ends.termination, BaTermination::kConverged) << seed;
    EXPECT_LE(ends.iterations, 2 * plucker.iterations) << seed;
    EXPECT_LT(ends.final_cost, 1.01 * plucker.final_cost) << seed;
  }
}

}  // namespace
}  // namespace plumbline
