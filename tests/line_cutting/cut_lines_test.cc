// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/cut_lines.h"

#include "plumbline/line_cutting/pose_information.h"

#include "tests/line_cutting/random_points.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

double Value(const CuttingProblem& problem, CuttingInformation kind) {
  return LogDeterminantOf(problem, CutLines(problem, kind), kind);
}

double Whole(const CuttingProblem& problem, CuttingInformation kind) {
  return LogDeterminantOf(problem, std::vector<LineCut>(problem.lines.size()), kind);
}

TEST(CutLines, RaisesTheInformationThatIsAskedFor) {
  for (const auto kind : {CuttingInformation::kIndependent, CuttingInformation::kPrinted}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const CuttingProblem problem = RandomProblem(seed, 12);
      EXPECT_GT(Value(problem, kind), Whole(problem, kind) + 0.1);
    }
  }
}

TEST(CutEachLine, ReturnsTheRiseOfTheInformation) {
  const auto kind = CuttingInformation::kIndependent;
  const CuttingProblem problem = RandomProblem(3, 12);
  std::vector<LineCut> cuts(12);
  const double gain = CutEachLine(problem, kind, cuts);
  EXPECT_EQ(cuts, CutLines(problem));
  EXPECT_NEAR(gain, LogDeterminantOf(problem, cuts, kind) - Whole(problem, kind), 1e-6);
  EXPECT_GE(CutEachLine(problem, kind, cuts), -1e-9);  // begins with the cuts
  EXPECT_GE(LogDeterminantOf(problem, cuts, kind), Value(problem, kind) - 1e-9);
}

TEST(CutLines, GainsNothingInTheCorrelatedInformation) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const CuttingProblem problem = RandomProblem(seed, 12);
    const auto kind = CuttingInformation::kCorrelated;
    const double full = Whole(problem, kind);
    EXPECT_GE(Value(problem, kind), full);
    EXPECT_LT(Value(problem, kind), full + 1e-3);
    // And what cutting seems to gain is none.
    EXPECT_LT(LogDeterminantOf(problem, CutLines(problem), kind), full + 1e-3);
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
  for (const LineCut& cut : CutLines(problem)) {
    EXPECT_TRUE(cut.used);
    EXPECT_GE(cut.first, 0);
    EXPECT_LE(cut.first, cut.second);
    EXPECT_LE(cut.second, 1);
  }
  EXPECT_TRUE(CutLines({}).empty());
}

TEST(ChooseAll, TakesAllPointsAndCutsLinesBesideThem) {
  const CuttingProblem problem = RandomProblem(7, 6);
  const std::vector<PointRows> points = RandomPoints(7, 8);
  CuttingProblem with_points = problem;
  with_points.other_information += SumPoints(points);
  const ChosenFeatures chosen = ChooseAll(problem, points, {.method = "greedy"});
  EXPECT_EQ(chosen.points, std::vector<bool>(8, true));
  EXPECT_EQ(chosen.lines, CutLines(with_points));
  EXPECT_NE(chosen.lines, CutLines(problem));
  EXPECT_TRUE(chosen.others);
}

TEST(CutLines, KeepsLinesWholeWhereThePrintedInformationIsNone) {
  const CuttingProblem problem = RandomProblem(10, 2);  // l^T H_x has rank 4
  EXPECT_EQ(CutLines(problem, CuttingInformation::kPrinted), std::vector<LineCut>(2));
}

TEST(CutLines, RefusesLinesBehindTheCamera) {
  CuttingProblem problem = RandomProblem(8, 5);
  problem.lines[2].segment_in_cam.end.z() = -1;
  EXPECT_THROW(CutLines(problem), BugError);
  problem = RandomProblem(8, 5);
  problem.lines[2].sigma_px = 0;
  EXPECT_THROW(CutLines(problem), BugError);
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
