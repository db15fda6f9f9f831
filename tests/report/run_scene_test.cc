// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_scene.h"

#include "tests/report/poster_run.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// The poster with its ground truth in a world that is turned and far away.
class TurnedPoster : public PosterDataset {
 public:
  explicit TurnedPoster(const Rigid3& world_from_poster)
      : PosterDataset(Turned(world_from_poster)) {}

 private:
  static DatasetInfo Turned(const Rigid3& world_from_poster) {
    DatasetInfo info = PosterDataset(6).info();
    for (StampedPose& pose : info.ground_truth->poses) {
      pose.world_from_camera = world_from_poster * pose.world_from_camera;
    }
    return info;
  }
};

// World z up: the camera's -y becomes z.
const Rigid3 kUpright{Eigen::Quaterniond(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX())),
                      {400, -300, 20}};

TEST(RunScene, IsInTheWorldOfTheGroundTruth) {
  const PosterRun run;
  const TurnedPoster dataset(kUpright);
  const RunScene scene = MakeRunScene(run.result(), dataset);
  ASSERT_EQ(scene.maps.size(), 1U);
  const MapScene& map = scene.maps[0];
  ASSERT_EQ(map.poses.size(), 4U);
  const Rigid3& truth = dataset.info().ground_truth->poses[5].world_from_camera;
  EXPECT_LT((map.poses[3].translation - truth.translation).norm(), 0.01);
  // The poster hangs 3 m ahead, along the world's y.
  double mean = 0;
  for (const Eigen::Vector3d& point : map.points) {
    mean += (point.y() + 300) / static_cast<double>(map.points.size());
  }
  EXPECT_NEAR(mean, MovingPoster::kDepth, 0.1);
  EXPECT_EQ(scene.up, Eigen::Vector3d(0, 0, 1));
  EXPECT_LT((scene.origin - map.poses[0].translation).norm(), 1e-12);
}

TEST(RunScene, WithoutGroundTruthIsInTheWorldOfTheFirstCamera) {
  const PosterRun run;
  const RunScene scene = MakeRunScene(run.result(), PosterDataset(6, false));
  EXPECT_FALSE(scene.maps[0].error);
  EXPECT_TRUE(scene.reference.empty());
  EXPECT_EQ(scene.up, Eigen::Vector3d(0, -1, 0));
  EXPECT_LT(scene.maps[0].poses[0].translation.norm(), 1e-9);
}

TEST(RunScene, TakesZAsUpForCamerasThatLookDown) {
  const PosterRun run;
  // Turned by 45 degrees between two axes: neither is nearest.
  const Rigid3 tilted{Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ())),
                      Eigen::Vector3d::Zero()};
  EXPECT_EQ(MakeRunScene(run.result(), TurnedPoster(tilted)).up, Eigen::Vector3d(0, 0, 1));
}

TEST(RunScene, ShowsEveryNthLandmarkOfALargeMap) {
  const PosterRun run;
  const RunScene all = MakeRunScene(run.result(), PosterDataset(6));
  const RunScene some =
      MakeRunScene(run.result(), PosterDataset(6), {.points = 40, .lines = 2, .reference = 3});
  ASSERT_GT(all.maps[0].points.size(), 80U);
  EXPECT_EQ(all.maps[0].points.size(), all.maps[0].point_count);
  EXPECT_EQ(some.maps[0].point_count, all.maps[0].point_count);
  EXPECT_LE(some.maps[0].points.size(), 40U);
  EXPECT_GT(some.maps[0].points.size(), 20U);
  EXPECT_LE(some.maps[0].lines.size(), 2U);
  EXPECT_EQ(some.reference.size(), 3U);
}

}  // namespace
}  // namespace plumbline
