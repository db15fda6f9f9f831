// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/reprojection.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

KeyFrame KeyFrameShowing(int id, const Rigid3& cam_from_world, const Eigen::Vector2d& px) {
  auto indexed = std::make_shared<FrameFeatures>();
  indexed->features.points.resize(1);
  indexed->features.points[0].px = px;
  indexed->features.point_disparity.resize(1);
  KeyFrame keyframe{KeyFrameId{id}, KeyFrameId{id - 1}, {}};
  keyframe.frame.cam_from_world = cam_from_world;
  keyframe.frame.indexed = indexed;
  keyframe.frame.points.resize(1);
  return keyframe;
}

// The point shows 3, 4 px off (5 px) in the first keyframe and 1 px off in the second; the third
// one looks the other way.
TEST(MeanReprojectionError, IsOfTheKeyFramesThatHaveThePointBeforeThem) {
  const RectifiedCamera camera = TestCamera();
  const Eigen::Vector3d position(0.3, -0.2, 4);
  const Rigid3 ahead{Eigen::Quaterniond::Identity(), {0.1, 0, 0}};
  const Rigid3 back{ExpSo3({0, 3, 0}), {0, 0, 0}};
  Map map;
  map.Apply({edit::AddKeyFrame{
                 KeyFrameShowing(0, Rigid3{}, camera.Project(position) + Eigen::Vector2d(3, -4))},
             edit::AddKeyFrame{KeyFrameShowing(
                 1, ahead, camera.Project(ahead * position) + Eigen::Vector2d(0, 1))},
             edit::AddKeyFrame{KeyFrameShowing(2, back, {0, 0})}});
  MapPoint point;
  point.id = PointId{0};
  point.position = position;
  point.observations = {{KeyFrameId{0}, 0}, {KeyFrameId{1}, 0}, {KeyFrameId{2}, 0}};
  map.Apply({edit::AddPoint{point}});
  EXPECT_NEAR(*ReprojectionError(camera, map.Find(KeyFrameId{0})->frame, 0, position), 5, 1e-12);
  EXPECT_FALSE(ReprojectionError(camera, map.Find(KeyFrameId{2})->frame, 0, position));
  EXPECT_NEAR(*MeanReprojectionError(camera, map, *map.Find(PointId{0})), 3, 1e-12);
}

TEST(MeanReprojectionError, IsNotOfAPointBehindAll) {
  Map map;
  map.Apply({edit::AddKeyFrame{KeyFrameShowing(0, Rigid3{}, {1, 1})}});
  MapPoint point;
  point.id = PointId{0};
  point.position = {0, 0, -1};
  point.observations = {{KeyFrameId{0}, 0}};
  map.Apply({edit::AddPoint{point}});
  EXPECT_FALSE(MeanReprojectionError(TestCamera(), map, *map.Find(PointId{0})));
}

// A map of two keyframes 0.1 apart, the second to the right of the first and turned, and a point
// this far ahead that both show; pixels have a deviation of 0.5.
Map PointAhead(double distance, const std::optional<Disparity>& disparity = std::nullopt) {
  const Rigid3 right{ExpSo3({0, 0.05, 0}), {-0.1, 0, 0}};
  MapPoint point;
  point.id = PointId{0};
  point.position = {0.1 * distance, 0, distance};
  point.observations = {{KeyFrameId{0}, 0}, {KeyFrameId{1}, 0}};
  Map map;
  for (int id = 0; id < 2; ++id) {
    KeyFrame keyframe = KeyFrameShowing(id, id == 0 ? Rigid3{} : right, {0, 0});
    auto indexed = std::make_shared<FrameFeatures>(*keyframe.frame.indexed);
    indexed->features.points[0].sigma_px = 0.5;
    if (disparity) indexed->features.point_disparity.Set(0, *disparity);
    keyframe.frame.indexed = indexed;
    map.Apply({edit::AddKeyFrame{keyframe}});
  }
  map.Apply({edit::AddPoint{point}});
  return map;
}

// The deviation of a distance by parallax, relative to the distance, is sqrt(2) 0.5 px over the
// shift between the two images, about fx 0.1 / distance: half at `limit`.
TEST(HasKnownDistance, IsWhatParallaxOrDisparitiesTell) {
  const RectifiedCamera camera = TestCamera();
  const double limit = camera.fx * 0.1 / (2 * std::sqrt(2) * 0.5);
  const auto is_known = [&](const Map& map) {
    return HasKnownDistance(camera, map, *map.Find(PointId{0}));
  };
  EXPECT_TRUE(is_known(PointAhead(0.9 * limit)));
  EXPECT_FALSE(is_known(PointAhead(1.1 * limit)));
  EXPECT_FALSE(is_known(PointAhead(1e6)));
  RectifiedCamera stereo = camera;
  stereo.baseline = 0.2;
  const double far = 1.1 * limit, disparity = stereo.DisparityFromDepth(far);
  const Map seen = PointAhead(far, Disparity{disparity, disparity});
  EXPECT_TRUE(HasKnownDistance(stereo, seen, *seen.Find(PointId{0})));
  const Map near = PointAhead(1);
  EXPECT_EQ(PointsOfKnownDistance(camera, near), std::vector{near.Find(PointId{0})});
  EXPECT_TRUE(PointsOfKnownDistance(camera, PointAhead(1e6)).empty());
}

}  // namespace
}  // namespace plumbline
