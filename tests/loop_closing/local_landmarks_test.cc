// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/local_landmarks.h"

#include "plumbline/base/error.h"

#include "tests/loop_closing/loop_scene.h"
#include <algorithm>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::MakeLoopScene;

TEST(LocalLandmarks, AreThoseOfTheKeyFrameAndItsNeighbours) {
  const auto scene = MakeLoopScene({});
  const LocalLandmarks alone = LandmarksAround(scene.map, KeyFrameId{20}, 0);
  const LocalLandmarks with = LandmarksAround(scene.map, KeyFrameId{20}, 4);
  EXPECT_TRUE(alone.neighbours.empty());
  EXPECT_EQ(with.neighbours.size(), 4U);
  EXPECT_GT(with.points.size(), alone.points.size());
  EXPECT_GT(with.lines.size(), alone.lines.size());
  EXPECT_TRUE(std::is_sorted(
      with.points.begin(), with.points.end(), [](auto* a, auto* b) { return a->id < b->id; }));
  for (const MapPoint* point : alone.points) {
    EXPECT_TRUE(point->observations.contains(KeyFrameId{20}));
  }
  EXPECT_THROW(LandmarksAround(scene.map, KeyFrameId{99}, 0), BugError);
}

TEST(PointInCamera, KnowsDepthWorstAndBetterWithMoreViews) {
  const auto scene = MakeLoopScene({});
  const Rigid3 pose = scene.map.PoseOf(KeyFrameId{20});
  const LocalLandmarks local = LandmarksAround(scene.map, KeyFrameId{20}, 0);
  double few = 0;
  double many = 0;
  for (const MapPoint* point : local.points) {
    const CameraPoint known = PointInCamera(scene.world.camera, scene.map, *point, pose);
    EXPECT_LT((known.place - pose * point->position).norm(), 1e-12);
    const Eigen::Vector3d ray = known.place.normalized();
    const double along = ray.dot(known.covariance * ray);
    EXPECT_GT(along, 0.2 * known.covariance.trace());
    (point->observations.size() < 4 ? few : many) =
        std::max(point->observations.size() < 4 ? few : many, along);
  }
  if (few > 0) {
    EXPECT_GT(few, many);
  }
}

TEST(CameraAmong, SeesDirectionsRightWhateverTheScale) {
  const Rigid3 keyframe = testing::MakeLoopScene({}).map.PoseOf(KeyFrameId{3});
  const Similarity3 camera_from_keyframe{0.4, ExpSo3({0.1, 0.2, 0.3}), {1, 2, 3}};
  const Eigen::Vector3d place(3, 1, 8);
  const Eigen::Vector3d direct = camera_from_keyframe * (keyframe * place);
  const Eigen::Vector3d among = CameraAmong(keyframe, camera_from_keyframe) * place;
  EXPECT_LT((direct.normalized() - among.normalized()).norm(), 1e-12);
}

TEST(SearchImage, FindsWhatTheKeyFrameShows) {
  const auto scene = MakeLoopScene({});
  const LocalLandmarks local = LandmarksAround(scene.map, KeyFrameId{20}, 0);
  const Frame& frame = local.keyframe->frame;
  const SearchedImage found =
      SearchImage(scene.Imaging(), local, frame.cam_from_world, *frame.indexed, {});
  EXPECT_EQ(found.projected_points.size(), local.points.size());
  EXPECT_GT(found.tested_points, 0.9 * static_cast<double>(local.points.size()));
  EXPECT_GT(found.points.size(), 0.9 * static_cast<double>(local.points.size()));
  int right = 0;
  for (const LandmarkMatch& match : found.points) {
    right += frame.points[static_cast<std::size_t>(match.feature)] ==
             local.points[static_cast<std::size_t>(match.landmark)]->id;
  }
  EXPECT_GT(right, 0.95 * static_cast<double>(found.points.size()));
  EXPECT_GT(found.lines.size(), 0.7 * static_cast<double>(local.lines.size()));
}

}  // namespace
}  // namespace plumbline
