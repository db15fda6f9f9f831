// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/reprojection.h"

#include "tests/support/random_geometry.h"
#include <memory>

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

}  // namespace
}  // namespace plumbline
