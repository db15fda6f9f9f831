// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/cutting_testbed/pose_from_lines.h"

#include "plumbline/cutting_testbed/scene.h"

#include <vector>

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

}  // namespace
}  // namespace plumbline
