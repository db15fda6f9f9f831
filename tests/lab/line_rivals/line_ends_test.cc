// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/line_ends.h"

#include "tests/optimization/random_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::MeasureLine;
using testing::StereoCamera;

const Segment3 kSegment{{-1, 0.2, 6}, {1.5, 0.8, 7}};

// One line, seen by two poses.
BaProblem OneLine() {
  BaProblem problem;
  problem.camera = StereoCamera();
  problem.poses.push_back({{}, true});
  problem.poses.push_back({ExpSe3(Vector6d::Constant(0.05)), false});
  problem.lines.push_back(ToOrthonormal(LineThroughPoints(kSegment.start, kSegment.end)));
  return problem;
}

BaProblem::LineObservation Observe(const BaProblem& problem, int pose, const Segment3& segment) {
  const Rigid3& cam_from_world = problem.poses[static_cast<std::size_t>(pose)].cam_from_world;
  return {pose, 0, MeasureLine(problem.camera, cam_from_world, segment, false, 1)};
}

TEST(TrimmedEnds, AreTheEndsThatTheFirstPoseSees) {
  BaProblem problem = OneLine();
  const Segment3 part{kSegment.Midpoint(), kSegment.end};
  problem.line_observations = {Observe(problem, 1, part), Observe(problem, 0, kSegment)};
  const Segment3 ends = TrimmedEnds(problem).front();
  EXPECT_LT((ends.start - kSegment.start).norm(), 1e-9);
  EXPECT_LT((ends.end - kSegment.end).norm(), 1e-9);
}

TEST(TrimmedEnds, TheRightCameraSeesTheSameEnds) {
  BaProblem problem = OneLine();
  problem.line_observations = {
      {1, 0, MeasureLine(problem.camera, problem.poses[1].cam_from_world, kSegment, true, 1)}};
  const Segment3 ends = TrimmedEnds(problem).front();
  EXPECT_LT((ends.start - kSegment.start).norm(), 1e-9);
  EXPECT_LT((ends.end - kSegment.end).norm(), 1e-9);
}

TEST(TrimmedEnds, FollowTheDirectionOfTheLineHoweverItWasMeasured) {
  BaProblem problem = OneLine();
  problem.line_observations = {Observe(problem, 0, kSegment.Reversed())};
  const Segment3 ends = TrimmedEnds(problem).front();
  EXPECT_GT(ends.Direction().dot(kSegment.Direction()), 1 - 1e-9);
}

TEST(TrimmedEnds, WithoutAUsableObservationLieAroundTheFoot) {
  BaProblem problem = OneLine();
  // A segment without length trims the line to one point.
  problem.line_observations = {Observe(problem, 0, {kSegment.start, kSegment.start})};
  const Segment3 ends = TrimmedEnds(problem).front();
  const PluckerLine line = ToPlucker(problem.lines.front());
  EXPECT_NEAR(ends.Length(), 2, 1e-9);
  EXPECT_LT((ends.Midpoint() - line.Foot()).norm(), 1e-9);
}

TEST(EndsOf, AreThoseOfTheProblemWhereItHasAny) {
  BaProblem problem = OneLine();
  problem.line_observations = {Observe(problem, 0, kSegment)};
  EXPECT_LT((EndsOf(problem).front().start - kSegment.start).norm(), 1e-9);
  const Segment3 pulled{kSegment.start, kSegment.end + 2 * kSegment.Direction()};
  problem.line_ends = {pulled};
  EXPECT_EQ(EndsOf(problem).front().end, pulled.end);
}

TEST(EndsOfLines, StayWhereTheMovedOnesMakeNoLine) {
  const Segment3 moved{{0, 0, 4}, {1, 0, 4}};
  const Segment3 point{{1, 2, 3}, {1, 2, 3}};
  const std::vector<Segment3> ends = EndsOfLines({kSegment, kSegment}, {moved, point});
  EXPECT_EQ(ends[0].end, moved.end);
  EXPECT_EQ(ends[1].end, kSegment.end);
}

TEST(LinesThroughEnds, KeepsUnmovedLinesBitByBit) {
  const BaProblem problem = OneLine();
  const std::vector<Segment3> before{kSegment};
  const auto same = LinesThroughEnds(problem.lines, before, before);
  EXPECT_EQ(same.front().U.coeffs(), problem.lines.front().U.coeffs());
  EXPECT_EQ(same.front().w, problem.lines.front().w);
  const Segment3 moved{{-1, 0, 6}, {1.5, 1, 7}};
  const PluckerLine line = ToPlucker(LinesThroughEnds(problem.lines, before, {moved}).front());
  EXPECT_LT(line.DistanceTo(moved.start), 1e-12);
  EXPECT_LT(line.DistanceTo(moved.end), 1e-12);
}

}  // namespace
}  // namespace plumbline
