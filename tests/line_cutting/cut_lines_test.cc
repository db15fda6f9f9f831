// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/cut_lines.h"

#include "plumbline/line_cutting/pose_information.h"

#include "tests/line_cutting/random_lines.h"
#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

double Value(const CuttingProblem& problem, const CuttingOptions& options) {
  return LogDeterminantOf(problem, CutLines(problem, options), options.information);
}

TEST(CutLines, RaisesTheInformationThatIsAskedFor) {
  for (const auto kind : {CuttingInformation::kIndependent, CuttingInformation::kPrinted}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const CuttingProblem problem = RandomProblem(seed, 12);
      const double full = Value(problem, {CuttingMethod::kNone, kind});
      const double greedy = Value(problem, {CuttingMethod::kGreedy, kind});
      const double sweeps = Value(problem, {CuttingMethod::kGreedySweeps, kind});
      const double joint = Value(problem, {CuttingMethod::kJoint, kind});
      EXPECT_GT(greedy, full + 0.1);
      EXPECT_GE(sweeps, greedy - 1e-9);
      EXPECT_GT(joint, full + 0.1);
    }
  }
}

TEST(CutLines, GainsNothingInTheCorrelatedInformation) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const CuttingProblem problem = RandomProblem(seed, 12);
    const auto kind = CuttingInformation::kCorrelated;
    const double full = Value(problem, {CuttingMethod::kNone, kind});
    for (const auto method : {CuttingMethod::kGreedy, CuttingMethod::kJoint}) {
      const double cut = Value(problem, {method, kind});
      EXPECT_GE(cut, full);
      EXPECT_LT(cut, full + 1e-3) << NameOf(method);
    }
    // And what cutting seems to gain is none.
    const auto cuts = CutLines(problem, {CuttingMethod::kGreedy});
    EXPECT_LT(LogDeterminantOf(problem, cuts, kind), full + 1e-3);
  }
}

// The weight in full, of ends that are known alike in every direction: v = g^T Sigma(a) g +
// sigma^2.
TEST(CutWeight, IsTheInverseVarianceOfEachDistance) {
  Rng rng(8, "cut weight");
  CuttableLine line = RandomLine(rng);
  line.start_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  line.end_covariance = 4e-4 * Eigen::Matrix3d::Identity();
  line.sigma_px = 0.7;
  const LineCut cut{0.2, 0.9};
  const auto distance = [&](const Eigen::Vector3d& point) {
    return LineDistance(line.image_line, TestCamera().Project(point));
  };
  const Eigen::Matrix2d weight =
      CutWeight(TestCamera(), line, cut, CuttingInformation::kIndependent);
  const Segment3 piece = CutSegment(line.segment_in_cam, cut);
  for (const int k : {0, 1}) {
    const double a = k == 0 ? cut.first : cut.second;
    const Eigen::Vector3d point = k == 0 ? piece.start : piece.end;
    Eigen::Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = 1e-5 * Eigen::Vector3d::Unit(axis);
      gradient(axis) = (distance(point + step) - distance(point - step)) / 2e-5;
    }
    const double point_variance = (1 - a) * (1 - a) * 1e-4 + a * a * 4e-4;
    const double variance = point_variance * gradient.squaredNorm() + 0.7 * 0.7;
    EXPECT_NEAR(weight(k, k) * variance, 1, 1e-6);
  }
  EXPECT_EQ(weight(0, 1), 0);
  EXPECT_EQ(weight(1, 0), 0);
}

TEST(CutLines, CutsLieOnTheLineInOrder) {
  const CuttingProblem problem = RandomProblem(5, 30);
  for (const auto method :
       {CuttingMethod::kGreedy, CuttingMethod::kGreedySweeps, CuttingMethod::kJoint}) {
    for (const LineCut& cut : CutLines(problem, {method})) {
      EXPECT_TRUE(cut.used);
      EXPECT_GE(cut.first, 0);
      EXPECT_LE(cut.first, cut.second);
      EXPECT_LE(cut.second, 1);
    }
  }
}

TEST(CutLines, LeavesOutTheMostUncertain) {
  CuttingProblem problem = RandomProblem(6, 10);
  for (const std::size_t i : {1U, 4U, 7U}) {
    problem.lines[i].start_covariance *= 1e4;
    problem.lines[i].end_covariance *= 1e4;
  }
  const auto cuts = CutLines(problem, {.method = CuttingMethod::kDrop, .drop_share = 0.3});
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    EXPECT_EQ(cuts[i].used, i != 1 && i != 4 && i != 7);
    EXPECT_EQ(cuts[i].first, 0);
    EXPECT_EQ(cuts[i].second, 1);
  }
  const auto all = CutLines(problem, {.method = CuttingMethod::kDrop, .drop_share = 1});
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const LineCut& c) { return c.used; }), 4);
}

TEST(CutLines, DoesNothingUnlessAsked) {
  const CuttingProblem problem = RandomProblem(7, 5);
  EXPECT_EQ(CutLines(problem, {}), std::vector<LineCut>(5));
  EXPECT_TRUE(CutLines({}, {CuttingMethod::kGreedy}).empty());
}

TEST(CutLines, KeepsLinesWholeWhereThePrintedInformationIsNone) {
  const CuttingProblem problem = RandomProblem(10, 2);  // l^T H_x has rank 4
  for (const auto method : {CuttingMethod::kGreedySweeps, CuttingMethod::kJoint}) {
    EXPECT_EQ(CutLines(problem, {method, CuttingInformation::kPrinted}), std::vector<LineCut>(2));
  }
}

TEST(CutLines, RefusesLinesBehindTheCamera) {
  CuttingProblem problem = RandomProblem(8, 5);
  problem.lines[2].segment_in_cam.end.z() = -1;
  EXPECT_THROW(CutLines(problem, {CuttingMethod::kGreedy}), BugError);
  problem = RandomProblem(8, 5);
  problem.lines[2].sigma_px = 0;
  EXPECT_THROW(CutLines(problem, {CuttingMethod::kGreedy}), BugError);
}

TEST(LineCut, ImageRatioIsThatOfTheProjectedPoint) {
  Rng rng(9);
  const RectifiedCamera camera = TestCamera();
  for (int trial = 0; trial < 10; ++trial) {
    const Segment3 segment = RandomLine(rng).segment_in_cam;
    const double ratio = rng.Uniform();
    const double image = ImageRatio(segment, ratio);
    const Eigen::Vector2d expected =
        (1 - image) * camera.Project(segment.start) + image * camera.Project(segment.end);
    EXPECT_LT((camera.Project(PointAt(segment, ratio)) - expected).norm(), 1e-9);
  }
}

TEST(LineCut, KeepsThePieceBetweenTheRatios) {
  const Segment3 piece = CutSegment({{0, 0, 2}, {4, 0, 6}}, {0.25, 0.75});
  EXPECT_LT((piece.start - Eigen::Vector3d(1, 0, 3)).norm(), 1e-12);
  EXPECT_LT((piece.end - Eigen::Vector3d(3, 0, 5)).norm(), 1e-12);
}

}  // namespace
}  // namespace plumbline
