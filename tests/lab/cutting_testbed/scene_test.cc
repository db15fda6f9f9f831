// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/scene.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

class Scenes : public ::testing::TestWithParam<SceneOptions> {};

TEST_P(Scenes, HaveErrorsAsLargeAsTheirCovariancesSay) {
  double sum = 0;
  int ends = 0;
  for (std::uint64_t index = 0; index < 100; ++index) {
    const CuttingScene scene = MakeCuttingScene(GetParam(), index);
    ASSERT_EQ(scene.problem.lines.size(), static_cast<std::size_t>(GetParam().lines));
    for (std::size_t i = 0; i < scene.problem.lines.size(); ++i) {
      const CuttableLine& line = scene.problem.lines[i];
      const Eigen::Vector3d start = line.segment_in_cam.start - scene.true_lines[i].start;
      const Eigen::Vector3d end = line.segment_in_cam.end - scene.true_lines[i].end;
      EXPECT_GT(line.segment_in_cam.start.z(), 0);
      EXPECT_GT(scene.true_lines[i].end.z(), 0);
      sum += start.dot(line.start_covariance.inverse() * start);
      sum += end.dot(line.end_covariance.inverse() * end);
      ends += 2;
    }
  }
  // Chi square with three degrees of freedom.
  EXPECT_NEAR(sum / ends, 3, 0.3);
}

TEST_P(Scenes, HaveMeasuredLinesWithinPixelsOfTheTrueOnes) {
  double sum = 0;
  int ends = 0;
  for (std::uint64_t index = 0; index < 50; ++index) {
    const CuttingScene scene = MakeCuttingScene(GetParam(), index);
    for (std::size_t i = 0; i < scene.problem.lines.size(); ++i) {
      for (const Eigen::Vector3d& point : {scene.true_lines[i].start, scene.true_lines[i].end}) {
        const double distance =
            LineDistance(scene.problem.lines[i].image_line, scene.problem.camera.Project(point));
        sum += distance * distance;
        ++ends;
      }
    }
  }
  EXPECT_NEAR(std::sqrt(sum / ends), 1, 0.1);
}

TEST_P(Scenes, AreTheSameForTheSameIndexAlone) {
  const CuttingScene scene = MakeCuttingScene(GetParam(), 3);
  const auto start = [&](std::uint64_t index) {
    return MakeCuttingScene(GetParam(), index).problem.lines[1].segment_in_cam.start;
  };
  EXPECT_EQ(scene.problem.lines[1].segment_in_cam.start, start(3));
  EXPECT_NE(scene.problem.lines[1].segment_in_cam.start, start(4));
}

INSTANTIATE_TEST_SUITE_P(All,
                         Scenes,
                         ::testing::Values(SceneOptions{SceneKind::kHomogeneousPoints, 0.002, 15},
                                           SceneOptions{SceneKind::kInverseDepthPoints, 0.002, 6},
                                           SceneOptions{SceneKind::kStereo, 0.02, 10}),
                         [](const auto& options) { return NameOf(options.param.kind); });

TEST(CuttingScene, KnowTheirMotion) {
  EXPECT_NEAR(MakeCuttingScene({SceneKind::kStereo, 0.05, 6}, 1).motion.norm(), 1, 1e-12);
  EXPECT_EQ(MakeCuttingScene({SceneKind::kInverseDepthPoints, 0.005, 6}, 1).motion.norm(), 0);
}

TEST(EdgeScene, SeesTheEdgeAtTheAngle) {
  for (const double angle : {0.1, 0.7, 1.5}) {
    const CuttingScene scene = MakeEdgeScene({SceneKind::kHomogeneousPoints, 0.005, 10}, angle, 1);
    const Eigen::Vector3d direction = scene.true_lines[0].Direction();
    EXPECT_NEAR(std::abs(direction.z()), std::cos(angle), 1e-9);
    EXPECT_GT(scene.true_lines[0].start.z(), 1);
    EXPECT_GT(scene.true_lines[0].end.z(), 1);
  }
}

}  // namespace
}  // namespace plumbline
