// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/landmark_consistency.h"

#include "tests/lab/consistency/shares.h"
#include "tests/support/true_map.h"
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Kind = ConsistencyKind;

// Samples of landmarks of a world whose points are on a wall.
std::vector<ConsistencySample> SamplesWith(double noise, double wall) {
  SyntheticWorld world = MakeSyntheticWorld(300, 400);
  for (auto& point : world.points) point.position.z() = 5;
  std::vector<Rigid3> poses;
  KeyFramePoses by_keyframe;
  for (int k = 0; k < 8; ++k) {
    poses.push_back(PoseOnPath(6 * k));
    by_keyframe[KeyFrameId{k}] = poses.back();
  }
  const TrueMap scene = MakeTrueMap(world, poses, {.noise = noise});
  std::vector<TrueLine> lines;
  for (const auto& line : world.lines) lines.push_back({line.segment});
  const std::vector<Parallelogram> surfaces = {{{-20, -20, wall}, {40, 0, 0}, {0, 40, 0}}};
  return LandmarkSamples(scene.map, world.camera, by_keyframe, {lines, surfaces});
}

TEST(LandmarkSamples, AreInsideAsOftenAsPromised) {
  const auto samples = SamplesWith(1, 5);
  EXPECT_GT(OfKind(samples, Kind::kPointLandmark).size(), 150U);
  EXPECT_GT(OfKind(samples, Kind::kLineLandmark).size(), 40U);
  EXPECT_NEAR(ShareInside(samples, Kind::kPointLandmark), 0.9, 0.06);
  EXPECT_NEAR(ShareInside(samples, Kind::kLineLandmark), 0.9, 0.09);
  EXPECT_NEAR(ShareInside(samples, Kind::kSegment), 0.9, 0.03);
  EXPECT_NEAR(ShareInside(samples, Kind::kRightSegment), 0.9, 0.03);
}

TEST(LandmarkSamples, AreOutsideWhereTheNoiseIsLarger) {
  const auto samples = SamplesWith(2.5, 5);
  EXPECT_LT(ShareInside(samples, Kind::kPointLandmark), 0.65);
  EXPECT_LT(ShareInside(samples, Kind::kLineLandmark), 0.5);
  EXPECT_LT(ShareInside(samples, Kind::kSegment), 0.5);
}

TEST(LandmarkSamples, CountPointsFarFromAllSurfacesAsOutside) {
  const auto points = OfKind(SamplesWith(0.01, 8), Kind::kPointLandmark);
  ASSERT_FALSE(points.empty());
  for (const ConsistencySample& sample : points) EXPECT_TRUE(std::isinf(sample.nees));
}

}  // namespace
}  // namespace plumbline
