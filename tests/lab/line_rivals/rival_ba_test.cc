// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/rival_ba.h"

#include "lab/line_rivals/line_ends.h"
#include "plumbline/base/error.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/tracking/projected_ends.h"

#include "tests/optimization/ba_properties.h"
#include "tests/optimization/ba_scene.h"
#include <cmath>
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

// Ends of lines, each pulled out by a third of their length.
std::vector<Segment3> PulledEnds(const BaProblem& problem) {
  std::vector<Segment3> ends = TrimmedEnds(problem);
  for (Segment3& e : ends) {
    const Eigen::Vector3d pull = (e.end - e.start) / 3;
    e = {e.start - pull, e.end + pull};
  }
  return ends;
}

// How far ends were pulled out along a line, in parts of the length that the line has in view.
double Pulled(const Segment3& ends, const Segment3& in_view) {
  const Eigen::Vector3d along = in_view.Direction();
  const double out = along.dot(ends.end - in_view.end) - along.dot(ends.start - in_view.start);
  return out / (2 * in_view.Length());
}

TEST(SolveRivalBa, EndsThatWerePulledAlongTheirLineStayThere) {
  for (const RivalLines& lines : {kEnds, kProjectedPoints}) {
    for (const bool diagonal : {true, false}) {
      const BaScene scene = MakeBaScene(3, {.sigma = 0.1, .perturbation = 0.02});
      BaProblem problem = scene.problem;
      for (auto& o : problem.line_observations) {
        if (!diagonal) o.measurement.covariance << 0.01, 0.001, 0.001, 0.01;
      }
      const std::vector<Segment3> in_view = TrimmedEnds(scene.truth);
      problem.line_ends = PulledEnds(problem);
      const BaResult result = SolveRivalBa(problem, {}, lines);
      ASSERT_EQ(result.line_ends.size(), problem.lines.size());
      int moved = 0;
      for (std::size_t i = 0; i < result.line_ends.size(); ++i) {
        const Segment3& ends = result.line_ends[i];
        moved += ends.start != problem.line_ends[i].start;
        EXPECT_NEAR(Pulled(ends, in_view[i]), 1.0 / 3, 0.15) << i;
        const PluckerLine line = ToPlucker(result.lines[i]);
        EXPECT_LT(line.DistanceTo(ends.start) + line.DistanceTo(ends.end), 1e-6) << i;
      }
      EXPECT_EQ(moved, static_cast<int>(problem.lines.size()));
      EXPECT_LT(LargestPoseError(result, scene.truth), 0.01);
    }
  }
}

// Nothing takes ends back, and damping only slows them: where they may go on, they drift.
TEST(SolveRivalBa, ProjectedEndsDriftFromAdjustmentToAdjustment) {
  const BaScene scene = MakeBaScene(3, {.lines = 30, .sigma = 1, .perturbation = 0.02});
  BaProblem problem = scene.problem;
  const std::vector<Segment3> in_view = TrimmedEnds(scene.truth);
  problem.line_ends = TrimmedEnds(problem);
  const auto mean_slide = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < in_view.size(); ++i) {
      sum += std::abs(Pulled(problem.line_ends[i], in_view[i]));
    }
    return sum / static_cast<double>(in_view.size());
  };
  std::vector<double> slides{mean_slide()};
  for (int k = 0; k < 3; ++k) {
    for (int adjustment = 0; adjustment < 10; ++adjustment) {
      BaResult result = SolveRivalBa(problem, {}, kProjectedPoints);
      problem.lines = result.lines;
      problem.line_ends = result.line_ends;
    }
    slides.push_back(mean_slide());
  }
  for (std::size_t k = 1; k < slides.size(); ++k) EXPECT_GT(slides[k], 1.02 * slides[k - 1]) << k;
}

// Lines of four parameters have no ends that could stay.
TEST(SolveRivalBa, OnlyEndPointsGiveEndsBack) {
  BaProblem problem = MakeBaScene(3, {}).problem;
  problem.line_ends = PulledEnds(problem);
  EXPECT_TRUE(SolveRivalBa(problem, {}, kLeft).line_ends.empty());
  EXPECT_TRUE(SolveRivalBa(problem, {}, kProjected).line_ends.empty());
  EXPECT_TRUE(SolveLocalBa(problem).line_ends.empty());
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
  constexpr std::size_t kMore = 6 * 2 * sizeof(float);
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
