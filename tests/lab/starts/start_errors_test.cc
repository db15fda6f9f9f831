// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_errors.h"

#include "tests/lab/starts/start_fixtures.h"
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kDegrees = 180 / std::numbers::pi;

StartErrors Compare(const InitialMap& map) {
  const SidewaysTruth truth;
  return CompareInitialMap(map, truth.Motion(0, 5), truth.DepthAt(0).get(), StartCamera());
}

std::string Exceeded(const StartErrors& errors) {
  StartMap map;
  map.errors = errors;
  return ExceededLimits(map, {});
}

TEST(StartErrors, ParallaxIsTheAngleBetweenTheRays) {
  const std::vector<Vector3d> points(20, Vector3d(0, 0, 2));
  const Rigid3 aside{Eigen::Quaterniond::Identity(), {-0.1, 0, 0}};
  EXPECT_NEAR(MedianParallaxDeg(points, aside, StartCamera()), kDegrees * std::atan(0.05), 1e-9);
  const Rigid3 turned{ExpSo3({0, 0.1, 0}), Vector3d::Zero()};
  EXPECT_NEAR(MedianParallaxDeg(points, turned, StartCamera()), 0, 1e-9);
  const Rigid3 towards{Eigen::Quaterniond::Identity(), {0, 0, -0.5}};
  EXPECT_NEAR(MedianParallaxDeg(points, towards, StartCamera()), 0, 1e-9);
}

TEST(StartErrors, ParallaxNeedsPointsThatBothSee) {
  std::vector<Vector3d> points(100, Vector3d(100, 0, 2));
  const Rigid3 aside{Eigen::Quaterniond::Identity(), {-0.1, 0, 0}};
  EXPECT_EQ(MedianParallaxDeg(points, aside, StartCamera()), 0);
  points.insert(points.end(), 9, Vector3d(0, 0, 2));
  EXPECT_EQ(MedianParallaxDeg(points, aside, StartCamera()), 0) << "less than ten";
  points.insert(points.end(), 3, Vector3d(0, 0, 2));
  EXPECT_GT(MedianParallaxDeg(points, aside, StartCamera()), 2);
  const Rigid3 beyond{Eigen::Quaterniond::Identity(), {0, 0, -3}};
  EXPECT_EQ(MedianParallaxDeg(points, beyond, StartCamera()), 0) << "behind the second camera";
}

TEST(StartErrors, TheTruthIsRightAtAnyScale) {
  for (const double scale : {0.01, 1.0, 40.0}) {
    const StartErrors errors = Compare(SidewaysTruth().Map(0, 5, scale));
    EXPECT_NEAR(*errors.rotation_deg, 0, 1e-6);
    EXPECT_NEAR(*errors.direction_deg, 0, 1e-6);
    EXPECT_NEAR(*errors.depth, 0, 1e-9);
    EXPECT_EQ(*errors.depth_outliers, 0);
    EXPECT_EQ(errors.compared, 192);
    EXPECT_EQ(Exceeded(errors), "");
  }
}

TEST(StartErrors, MeasuresRotationAndDirection) {
  InitialMap map = SidewaysTruth().Map(0, 5, 1);
  Rigid3& pose = map.views.back().cam_from_world;
  const Vector3d centre = Inverse(pose).translation;
  pose.rotation = ExpSo3({0, 0, 0.6 / kDegrees}) * pose.rotation;
  const Vector3d turned = ExpSo3(Vector3d(0, 0, 6 / kDegrees)) * centre;
  pose.translation = -(pose.rotation * turned);
  const StartErrors errors = Compare(map);
  EXPECT_NEAR(*errors.rotation_deg, 0.6, 1e-9);
  EXPECT_NEAR(*errors.direction_deg, 6, 1e-9);
  EXPECT_EQ(Exceeded(errors), "rotation direction");
}

TEST(StartErrors, TheWorldOfTheMapNeedNotBeItsFirstView) {
  InitialMap map = SidewaysTruth().Map(0, 5, 2);
  const Rigid3 world_from_other{ExpSo3({0.3, -1, 0.2}), {4, 5, 6}};
  for (InitialView& view : map.views) {
    view.cam_from_world = view.cam_from_world * Inverse(world_from_other);
  }
  for (InitialPoint& point : map.points) point.position = world_from_other * point.position;
  EXPECT_EQ(Exceeded(Compare(map)), "");
}

TEST(StartErrors, AMirroredMapIsWrong) {
  InitialMap map = SidewaysTruth().Map(0, 5, 1);
  map.views.back().cam_from_world.translation *= -1;
  for (InitialPoint& point : map.points) point.position *= -1;
  const StartErrors errors = Compare(map);
  EXPECT_NEAR(*errors.direction_deg, 180, 1e-6);
  EXPECT_TRUE(std::isinf(*errors.depth));
  EXPECT_EQ(*errors.depth_outliers, 1);
  EXPECT_EQ(Exceeded(errors), "direction depth");
}

TEST(StartErrors, AFlatMapOfADeepSceneIsWrong) {
  InitialMap map = SidewaysTruth().Map(0, 5, 1);
  for (InitialPoint& point : map.points) point.position /= point.position.z();
  const StartErrors errors = Compare(map);
  EXPECT_GT(*errors.depth, 0.1);
  EXPECT_GT(*errors.depth_outliers, 0.3);
  EXPECT_EQ(Exceeded(errors), "depth");
}

TEST(StartErrors, DepthIsComparedInInverse) {
  InitialMap map = SidewaysTruth().Map(0, 5, 1);
  // A quarter of the points at infinity: inverse depth 0, off by all of it.
  for (std::size_t i = 0; i < map.points.size(); i += 4) map.points[i].position *= 1e9;
  const StartErrors errors = Compare(map);
  EXPECT_NEAR(*errors.depth, 0, 1e-9);
  EXPECT_NEAR(*errors.depth_outliers, 0.25, 1e-9);
}

TEST(StartErrors, SaysNothingWhereTheTruthIsNotKnown) {
  const SidewaysTruth truth;
  InitialMap map = truth.Map(0, 5, 1);
  const StartErrors nothing = CompareInitialMap(map, std::nullopt, nullptr, StartCamera());
  EXPECT_FALSE(nothing.rotation_deg || nothing.direction_deg || nothing.depth);
  map.points.resize(9);
  const StartErrors few = Compare(map);
  EXPECT_EQ(few.compared, 9);
  EXPECT_FALSE(few.depth);
}

TEST(StartErrors, NoDirectionIsRightWithoutMotion) {
  const StartErrors errors =
      CompareInitialMap(SidewaysTruth().Map(0, 5, 1), Rigid3{}, nullptr, StartCamera());
  EXPECT_EQ(*errors.direction_deg, 180);
}

TEST(StartErrors, AMapFromTooLittleParallaxIsWrongWhereAskedFor) {
  StartMap map;
  map.parallax_deg = 0.4;
  EXPECT_EQ(ExceededLimits(map, {}), "");
  StartLimits limits;
  limits.parallax_deg = 0.5;
  EXPECT_EQ(ExceededLimits(map, limits), "parallax");
  map.parallax_deg = 0.6;
  EXPECT_EQ(ExceededLimits(map, limits), "");
}

}  // namespace
}  // namespace plumbline
