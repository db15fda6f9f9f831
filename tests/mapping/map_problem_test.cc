// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/map_problem.h"

#include "tests/support/true_map.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr KeyFrameId kOrigin{1};

// Keyframes 1 and 3 of a map of four, the first of them fixed.
class MapProblemTest : public ::testing::Test {
 protected:
  MapProblemTest()
      : scene_(MakeTrueMap(world_,
                           {PoseOnPath(0), PoseOnPath(6), PoseOnPath(12), PoseOnPath(18)},
                           {.noise = 0, .missed = 0})),
        builder_(scene_.map, world_.Imaging(), LineWeighting::kCovariance, kOrigin, part_) {
    builder_.AddPose(kOrigin, true);
    builder_.AddPose(KeyFrameId{3}, false);
  }

  // What all four keyframes see.
  template <class Landmark>
  static const Landmark& SeenByAll(const IdTable<decltype(Landmark::id), Landmark>& landmarks) {
    for (const auto& [id, landmark] : landmarks) {
      if (landmark.observations.size() == 4) return landmark;
    }
    throw std::logic_error("no landmark is seen by all");
  }

  SyntheticWorld world_ = MakeSyntheticWorld(300, 100);
  TrueMap scene_;
  MapProblem part_;
  MapProblemBuilder builder_;
};

TEST_F(MapProblemTest, HasItsOriginAtACamera) {
  const auto& poses = part_.problem.poses;
  EXPECT_LT(LogSe3(poses[0].cam_from_world).norm(), 1e-12);
  EXPECT_LT(
      LogSe3(Inverse(poses[1].cam_from_world) * (PoseOnPath(18) * Inverse(PoseOnPath(6)))).norm(),
      1e-9);
  EXPECT_EQ(builder_.PoseOf(KeyFrameId{3}), 1);
  EXPECT_EQ(builder_.PoseOf(KeyFrameId{2}), MapProblemBuilder::kNoPose);
}

TEST_F(MapProblemTest, TakesTheViewsOfItsKeyFramesOnly) {
  const MapPoint& point = SeenByAll(scene_.map.points());
  const auto& views = builder_.ViewsOf(point.observations);
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[0].pose, 0);
  EXPECT_EQ(static_cast<int>(views[1].feature), point.observations.at(KeyFrameId{3}));
  builder_.AddPoint(point);
  MapPoint alone = point;
  alone.observations = {{kOrigin, 0}, {KeyFrameId{2}, 0}};
  builder_.AddPoint(alone);  // one view is not enough
  EXPECT_EQ(part_.points, std::vector{point.id});
  ASSERT_EQ(part_.problem.point_observations.size(), 2U);
  for (const auto& o : part_.problem.point_observations) {
    const auto& pose = part_.problem.poses[static_cast<std::size_t>(o.pose)];
    const Eigen::Vector2d px =
        world_.camera.Project(pose.cam_from_world * part_.problem.points.front());
    EXPECT_LT((px - o.measurement.px).norm(), 1e-6);
  }
}

TEST_F(MapProblemTest, TakesLinesInBothImagesOrInOne) {
  const MapLine& landmark = SeenByAll(scene_.map.lines());
  const int line = builder_.AddLine(landmark.line);
  const std::vector<MapProblemBuilder::View> views = builder_.ViewsOf(landmark.observations);
  builder_.AddLineView(line, views[0], false);
  builder_.AddLineView(line, views[1], true);
  const auto& observations = part_.problem.line_observations;
  ASSERT_EQ(observations.size(), 3U);
  EXPECT_EQ(observations[1].measurement.camera, 0);
  EXPECT_EQ(observations[2].measurement.camera, 1);
  const PluckerLine in_world =
      Transform(Inverse(part_.problem_from_world), ToPlucker(part_.problem.lines.front()));
  EXPECT_LT((in_world.Foot() - landmark.line.Foot()).norm(), 1e-9);
}

TEST_F(MapProblemTest, GivesBackWhatMovedAndWhatDidNotFit) {
  builder_.AddPoint(SeenByAll(scene_.map.points()));
  BaResult result = InitialState(part_.problem);
  const Rigid3 step = ExpSe3(Vector6d::Constant(0.01));
  result.poses[1] = step * result.poses[1];
  result.point_inliers[1] = false;
  const MapEdit edit = PosesAndPointsOf(part_, result);
  ASSERT_EQ(edit.size(), 3U);  // the fixed pose stays as it is
  const auto& pose = std::get<edit::SetPose>(edit[0]);
  EXPECT_EQ(pose.id, KeyFrameId{3});
  EXPECT_LT(LogSe3(Inverse(pose.cam_from_world) * (step * PoseOnPath(18))).norm(), 1e-9);
  const auto& moved = std::get<edit::MovePoint>(edit[1]);
  EXPECT_LT((moved.position - scene_.map.Find(moved.id)->position).norm(), 1e-9);
  EXPECT_EQ(std::get<edit::RemovePointObservation>(edit[2]).keyframe, KeyFrameId{3});
  const auto poses = PosesByKeyFrame(part_, result);
  EXPECT_LT(LogSe3(Inverse(poses.at(kOrigin)) * PoseOnPath(6)).norm(), 1e-9);
}

}  // namespace
}  // namespace plumbline
