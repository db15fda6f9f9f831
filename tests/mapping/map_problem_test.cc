// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/map_problem.h"

#include "plumbline/base/random.h"
#include "plumbline/mapping/local_ba_window.h"
#include "plumbline/optimization/bundle_adjustment.h"

#include "tests/support/true_map.h"
#include <cmath>
#include <cstddef>
#include <vector>

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

namespace scale_of_map_test {

// Three poses of one camera, none of them at the origin, and forty points and a line before them.
BaProblem Scene() {
  BaProblem problem;
  problem.camera = TestCamera();
  problem.camera.baseline = 0;
  for (int k = 0; k < 3; ++k) {
    problem.poses.push_back({PoseOnPath(3 + 8 * k), k == 0, true});
  }
  Rng rng(1, "unit_of_length");
  for (int i = 0; i < 40; ++i) {
    const double depth = 2 + 7 * rng.Uniform();
    const double x = 2 * rng.Uniform() - 1, y = 2 * rng.Uniform() - 1;
    const Eigen::Vector3d in_camera{depth * x, depth * y, depth};
    problem.points.push_back(Inverse(problem.poses[1].cam_from_world) * in_camera);
    for (int pose = 0; pose < 3; ++pose) problem.point_observations.push_back({pose, i, {}});
  }
  const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, 3).normalized();
  problem.lines.push_back(ToOrthonormal({problem.points[0].cross(direction), direction}));
  problem.line_ends.push_back({problem.points[0], problem.points[0] + direction});
  return problem;
}

// The scene as another unit of length has it, with the first camera where it was.
BaResult Enlarged(const BaProblem& problem, double factor) {
  const Eigen::Vector3d centre = Inverse(problem.poses[0].cam_from_world).translation;
  BaResult result = InitialState(problem);
  for (Rigid3& pose : result.poses) {
    Rigid3 world_from_cam = Inverse(pose);
    world_from_cam.translation = centre + factor * (world_from_cam.translation - centre);
    pose = Inverse(world_from_cam);
  }
  for (auto& point : result.points) point = centre + factor * (point - centre);
  const Eigen::Vector3d direction = ToPlucker(problem.lines[0]).direction;
  result.lines[0] = ToOrthonormal({result.points[0].cross(direction), direction});
  for (Segment3& ends : result.line_ends) {
    ends = {centre + factor * (ends.start - centre), centre + factor * (ends.end - centre)};
  }
  return result;
}

TEST(UnitOfLength, ScaleIsTheMedianOfDepths) {
  const BaProblem problem = Scene();
  BaResult result = Enlarged(problem, 1.7);
  for (std::size_t i = 0; i < 10; ++i) result.points[i] *= 4;  // a quarter goes elsewhere
  for (const double scale : ScalesOf(problem, result)) EXPECT_NEAR(scale, 1.7, 1e-12);
}

TEST(UnitOfLength, ScalesOfMeasuredLengthsAreOne) {
  BaProblem problem = Scene();
  problem.camera.baseline = 0.1;
  for (const double scale : ScalesOf(problem, Enlarged(problem, 1.7))) EXPECT_EQ(scale, 1);
}

TEST(UnitOfLength, PlaceOfAPoseIsKeptWithAllTheRest) {
  const BaProblem problem = Scene();
  BaResult result = Enlarged(problem, 1.7);
  KeepPlaceOf(2, problem, result);
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    EXPECT_LT(LogSe3(result.poses[k] * Inverse(problem.poses[k].cam_from_world)).norm(), 1e-9);
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    EXPECT_LT((result.points[i] - problem.points[i]).norm(), 1e-9);
  }
  const auto expected = problem.lines[0].Homogeneous();
  EXPECT_LT((result.lines[0].Homogeneous() - expected).norm(), 1e-9);
  EXPECT_LT((result.line_ends[0].end - problem.line_ends[0].end).norm(), 1e-9);
  BaProblem pair = problem;
  pair.camera.baseline = 0.1;
  BaResult measured = Enlarged(problem, 1.7);
  KeepPlaceOf(2, pair, measured);
  EXPECT_EQ(measured.points[0], Enlarged(problem, 1.7).points[0]);
}

TEST(UnitOfLength, IsKeptWithPosesPointsAndLines) {
  const BaProblem problem = Scene();
  BaResult result = Enlarged(problem, 1.7);
  FixScaleToOldestKeyFrame(problem, result);
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const Rigid3& expected = problem.poses[k].cam_from_world;
    EXPECT_LT((result.poses[k].translation - expected.translation).norm(), 1e-12);
    EXPECT_LT(result.poses[k].rotation.angularDistance(expected.rotation), 1e-7);
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    EXPECT_LT((result.points[i] - problem.points[i]).norm(), 1e-12);
  }
  const auto expected = problem.lines[0].Homogeneous();
  EXPECT_LT((result.lines[0].Homogeneous() - expected).norm(), 1e-12);
}

TEST(UnitOfLength, IsLeftToPosesThatHoldIt) {
  BaProblem problem = Scene();
  problem.poses[1].fixed = true;
  BaResult result = Enlarged(problem, 1.7);
  FixScaleToOldestKeyFrame(problem, result);
  EXPECT_EQ(result.points[0], Enlarged(problem, 1.7).points[0]);
  EXPECT_EQ(result.poses[2].translation, Enlarged(problem, 1.7).poses[2].translation);
}

// What the adjustment of a window that is the whole map of one camera does to the unit, and that
// it is kept.
TEST(UnitOfLength, IsLostByAnAdjustmentAndKeptAfterIt) {
  SyntheticWorld world = MakeSyntheticWorld(300, 40);
  world.camera.baseline = 0;
  std::vector<Rigid3> poses;
  for (int k = 0; k < 5; ++k) poses.push_back(PoseOnPath(6 * k));
  const TrueMap scene = MakeTrueMap(world, poses, {.depth = false, .noise = 0.5, .missed = 0});
  LocalBaWindow window = MakeLocalBaWindow(scene.map, world.Imaging(), KeyFrameId{4}, {}, {});
  Rng rng(2, "unit_of_length");
  for (auto& point : window.problem.points) point *= 1 + 0.2 * rng.Normal();
  BaResult result = SolveLocalBa(window.problem, {});
  EXPECT_GT(std::abs(ScalesOf(window.problem, result).front() - 1), 1e-3);
  FixScaleToOldestKeyFrame(window.problem, result);
  EXPECT_NEAR(ScalesOf(window.problem, result).front(), 1, 1e-12);
}

}  // namespace scale_of_map_test

}  // namespace plumbline
