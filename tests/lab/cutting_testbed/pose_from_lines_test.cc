// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/pose_from_lines.h"

#include "lab/cutting_testbed/scene.h"
#include "plumbline/line_cutting/cut_residuals.h"

#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

// The true lines of a scene seen without error, moved by `present_from_true`.
std::vector<WeightedCut> ExactLines(const CuttingScene& scene, const Rigid3& present_from_true) {
  std::vector<WeightedCut> lines;
  for (std::size_t i = 0; i < scene.true_lines.size(); ++i) {
    const Segment3& line = scene.true_lines[i];
    WeightedCut term{scene.problem.lines[i], {0.1, 0.8}};
    term.line.segment_in_cam = {present_from_true * line.start, present_from_true * line.end};
    term.line.image_line = LineThrough(
        {scene.problem.camera.Project(line.start), scene.problem.camera.Project(line.end)});
    lines.push_back(term);
  }
  return lines;
}

Rigid3 SmallMotion() {
  Vector6d tangent;
  tangent << 0.02, -0.03, 0.01, 0.05, -0.04, 0.06;
  return ExpSe3(tangent);
}

TEST(PoseFromLines, FindsTheMotionOfLinesWithoutErrors) {
  const CuttingScene scene = MakeCuttingScene({SceneKind::kStereo, 0.05, 10}, 1);
  const auto lines = ExactLines(scene, SmallMotion());
  const Rigid3 error = SolvePoseFromLines(scene.problem.camera, lines) * SmallMotion();
  EXPECT_LT(LogSe3(error).norm(), 1e-7);
}

TEST(PoseFromLines, LeavesOutLinesThatAreNotUsedAndHeedsWeights) {
  const CuttingScene scene = MakeCuttingScene({SceneKind::kStereo, 0.05, 12}, 2);
  auto lines = ExactLines(scene, SmallMotion());
  lines[3].line.image_line.z() += 200;
  lines[5].line.image_line.z() += 200;
  const auto error = [&] {
    return LogSe3(SolvePoseFromLines(scene.problem.camera, lines) * SmallMotion()).norm();
  };
  EXPECT_GT(error(), 1e-3);
  lines[3].cut.used = false;
  lines[5].weight *= 1e-12;
  EXPECT_LT(error(), 1e-6);
}

TEST(PoseFromLines, OfPointsToBeAdjustedFindsTheMotionOfLinesWithoutErrors) {
  const CuttingScene scene = MakeCuttingScene({SceneKind::kStereo, 0.05, 10}, 1);
  const auto lines = ExactLines(scene, SmallMotion());
  const Rigid3 error = SolvePoseAndPoints(scene.problem.camera, lines) * SmallMotion();
  EXPECT_LT(LogSe3(error).norm(), 1e-6);
}

// The cost that it minimizes, by brute force over the point: at the solution no small motion is
// better.
TEST(PoseFromLines, OfPointsToBeAdjustedIsMostLikely) {
  const CuttingScene scene = MakeCuttingScene({SceneKind::kStereo, 0.05, 8}, 3);
  std::vector<WeightedCut> lines;
  for (const CuttableLine& line : scene.problem.lines) lines.push_back({line, {0, 1}});
  const RectifiedCamera& camera = scene.problem.camera;
  // Squared residual and distance from the measured point, both in sigmas, at their least along the
  // direction Sigma g in which the point moves.
  const auto cost = [&](const Rigid3& motion) {
    double sum = 0;
    for (const WeightedCut& term : lines) {
      for (const bool end : {false, true}) {
        const Segment3& segment = term.line.segment_in_cam;
        const Eigen::Matrix3d& sigma = end ? term.line.end_covariance : term.line.start_covariance;
        Eigen::Vector3d shift = Eigen::Vector3d::Zero();
        for (int i = 0; i < 20; ++i) {
          const Eigen::Vector3d x = motion * ((end ? segment.end : segment.start) + shift);
          CuttableLine point = term.line;
          point.segment_in_cam = {x, x};
          const CutResidual r = EvaluateCutPoint(camera, point, 0);
          const Eigen::Vector3d g = motion.rotation.conjugate() * r.gradient;
          const double variance = g.dot(sigma * g) + 1;
          shift = -sigma * g * ((r.r - g.dot(shift)) / variance);
          if (i == 19) sum += r.r * r.r + shift.dot(sigma.ldlt().solve(shift));
        }
      }
    }
    return sum;
  };
  const Rigid3 found = SolvePoseAndPoints(camera, lines);
  const double least = cost(found);
  EXPECT_LT(least, cost(Rigid3{}));
  for (int i = 0; i < 6; ++i) {
    for (const double step : {-1e-3, 1e-3}) {
      EXPECT_GT(cost(RetractLeft(found, step * Vector6d::Unit(i))), least - 1e-6) << i;
    }
  }
}

}  // namespace
}  // namespace plumbline
