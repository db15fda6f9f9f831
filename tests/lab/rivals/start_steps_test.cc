// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/start_steps.h"

#include "plumbline/geometry/se3.h"

#include "tests/support/synthetic_world.h"
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// A point 4 m ahead seen from 0.4 m to the side.
TEST(MedianParallax, IsTheAngleAtThePoint) {
  const Rigid3 pose{ExpSo3({0, 0.1, 0}), ExpSo3({0, 0.1, 0}) * Eigen::Vector3d(-0.4, 0, 0)};
  const Eigen::Vector3d in_b = pose * Eigen::Vector3d(0, 0, 4);
  const std::vector<RayMatch> matches{{{0, 0}, in_b.hnormalized()}};
  EXPECT_NEAR(MedianParallax(matches, pose.rotation), std::atan(0.1), 1e-12);
  EXPECT_EQ(MedianParallax({}, pose.rotation), 0);
}

TEST(ParallaxOf, IsWhatSoManyMatchesReach) {
  std::vector<RayMatch> matches;
  for (const double offset : {0.1, 0.3, 0.2}) matches.push_back({{0, 0}, {offset, 0}});
  const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
  EXPECT_NEAR(ParallaxOf(1, matches, still), std::atan(0.3), 1e-12);
  EXPECT_NEAR(ParallaxOf(2, matches, still), std::atan(0.2), 1e-12);
  EXPECT_NEAR(ParallaxOf(9, matches, still), std::atan(0.1), 1e-12);
  EXPECT_EQ(ParallaxOf(1, {}, still), 0);
}

TEST(RayMatchesOf, AreThoseOfTheMatchedFeatures) {
  const SyntheticWorld world = MakeSyntheticWorld(600, 60);
  Rng rng(1);
  const SyntheticFrame a = Sense(world, PoseOnPath(0), {}, rng);
  const SyntheticFrame b = Sense(world, PoseOnPath(5), {}, rng);
  const std::vector<FeatureMatch> matches{{3, 7, 0}};
  const auto rays = RayMatchesOf(world.camera, a.indexed->features, b.indexed->features, matches);
  ASSERT_EQ(rays.size(), 1U);
  const PointFeature& in_b = b.indexed->features.points[7];
  EXPECT_LT((world.camera.Project(rays[0].b.homogeneous()) - in_b.px).norm(), 1e-9);
  EXPECT_NEAR(rays[0].sigma_b * 427.5, in_b.sigma_px, 1e-9);  // mean of 435 and 420
}

}  // namespace
}  // namespace plumbline
