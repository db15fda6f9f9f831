// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/landmark_creation.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <set>
#include <variant>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// A true map in which the last keyframe and one before share some landmarks but have also features
// without any: what CreatePointsFromViews and CreateLinesFromViews are for.
TrueMap WithFreeFeatures(const SyntheticWorld& world,
                         const std::vector<Rigid3>& poses,
                         const SensorModel& sensor) {
  TrueMap scene = MakeTrueMap(world, poses, sensor);
  MapEdit edit;
  for (const auto& [index, id] : scene.point_of) {
    if (index % 3 != 0) edit.push_back(edit::RemovePoint{id});
  }
  for (const auto& [index, id] : scene.line_of) {
    if (index % 3 != 0) edit.push_back(edit::RemoveLine{id});
  }
  scene.map.Apply(edit);
  scene.map.CheckInvariants();
  return scene;
}

template <class Change>
std::vector<Change> Only(const MapEdit& edit) {
  std::vector<Change> found;
  for (const MapChange& change : edit) {
    if (const auto* c = std::get_if<Change>(&change)) found.push_back(*c);
  }
  return found;
}

// Which landmark of the world each observation is of; a set of one when they agree.
template <class Landmark>
std::set<std::size_t> Truths(const TrueMap& scene,
                             const Landmark& landmark,
                             std::vector<std::size_t> SyntheticFrame::*truth) {
  std::set<std::size_t> truths;
  for (const auto& [keyframe, feature] : landmark.observations) {
    const SyntheticFrame& sensed = scene.sensed[static_cast<std::size_t>(keyframe.value)];
    truths.insert((sensed.*truth)[static_cast<std::size_t>(feature)]);
  }
  return truths;
}

double LineError(const PluckerLine& line, const Segment3& truth) {
  return std::max(line.DistanceTo(truth.start), line.DistanceTo(truth.end));
}

const SensorModel kStereo{.noise = 0.3, .missed = 0};
const SensorModel kMono{.depth = false, .noise = 0.3, .missed = 0};

TEST(CreateFromDepth, FillsUpWithTheBestKnownOfPoorDepths) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 80);
  TrueMap scene = WithFreeFeatures(world, {PoseOnPath(0), PoseOnPath(20)}, kStereo);
  const KeyFrameId id{1};
  const Frame& frame = scene.map.Find(id)->frame;
  int present = 0;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    present += frame.points[i].valid() && frame.features().point_disparity[i].has_value();
  }
  LandmarkCreationOptions options;
  options.max_relative_depth_sigma = 0.001;  // none is known so well
  options.min_depth_points = present + 10;
  const auto relative_sigma = [&](const MapPoint& point) {
    const auto& d =
        frame.features()
            .point_disparity[static_cast<std::size_t>(point.observations.begin()->second)];
    return d->sigma_px / d->px;
  };
  const auto points =
      Only<edit::AddPoint>(CreateFromDepth(scene.map, world.Imaging(), id, options));
  ASSERT_EQ(points.size(), 10U);
  double worst = 0;
  for (const auto& add : points) worst = std::max(worst, relative_sigma(add.landmark));
  options.min_depth_points = 100000;
  int better = 0;
  for (const auto& add :
       Only<edit::AddPoint>(CreateFromDepth(scene.map, world.Imaging(), id, options))) {
    EXPECT_LE(relative_sigma(add.landmark), 0.3);
    better += relative_sigma(add.landmark) <= worst;
  }
  EXPECT_EQ(better, 10);
}

TEST(CreateFromDepth, MakesALandmarkOfEveryFreeFeatureWithGoodDepth) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 80);
  TrueMap scene = WithFreeFeatures(world, {PoseOnPath(0), PoseOnPath(20)}, kStereo);
  const KeyFrameId id{1};
  const Frame before = scene.map.Find(id)->frame;
  LandmarkCreationOptions options;
  options.max_relative_depth_sigma = 0.1;
  options.max_relative_line_depth_sigma = 0.1;
  options.min_depth_points = 0;
  const MapEdit edit = CreateFromDepth(scene.map, world.Imaging(), id, options);
  const auto points = Only<edit::AddPoint>(edit);
  const auto lines = Only<edit::AddLine>(edit);
  EXPECT_EQ(points.size() + lines.size(), edit.size());
  std::size_t free_points = 0;
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    const auto& d = before.features().point_disparity[i];
    free_points += !before.points[i].valid() && d->sigma_px <= 0.1 * d->px;
  }
  EXPECT_EQ(points.size(), free_points);
  EXPECT_GT(lines.size(), 5U);
  for (const auto& add : points) {
    EXPECT_EQ(add.landmark.created_by, id);
    EXPECT_EQ(add.landmark.observations.size(), 1U);
    const auto truths = Truths(scene, add.landmark, &SyntheticFrame::point_truth);
    const Eigen::Vector3d truth = world.points[*truths.begin()].position;
    EXPECT_LT((add.landmark.position - truth).norm(), 0.1 * truth.norm());
  }
  for (const auto& add : lines) {
    const auto truths = Truths(scene, add.landmark, &SyntheticFrame::line_truth);
    const Segment3& truth = world.lines[*truths.begin()].segment;
    EXPECT_LT(LineError(add.landmark.line, truth), 0.2 * truth.start.norm());
    EXPECT_GT(add.landmark.line.direction.dot(truth.Direction()), 0.8);
    EXPECT_LT(add.landmark.start, add.landmark.end);
    EXPECT_GT(add.landmark.information.trace(), 0);
  }
  scene.map.Apply(edit);
  scene.map.CheckInvariants();
  EXPECT_TRUE(CreateFromDepth(scene.map, world.Imaging(), id, options).empty());
}

TEST(CreatePointsFromViews, TriangulatesWhatTwoKeyFramesShow) {
  for (const SensorModel& sensor : {kMono, kStereo}) {
    const SyntheticWorld world = MakeSyntheticWorld(400, 0);
    TrueMap scene = WithFreeFeatures(world, {PoseOnPath(0), PoseOnPath(25)}, sensor);
    const KeyFrameId id{1};
    const MapEdit edit = CreatePointsFromViews(scene.map, world.Imaging(), id, {});
    const auto points = Only<edit::AddPoint>(edit);
    EXPECT_EQ(points.size(), edit.size());
    EXPECT_GT(points.size(), 80U);
    std::size_t wrong = 0;
    for (const auto& add : points) {
      EXPECT_EQ(add.landmark.observations.size(), 2U);
      const auto truths = Truths(scene, add.landmark, &SyntheticFrame::point_truth);
      wrong += truths.size() != 1;
      const Eigen::Vector3d& truth = world.points[*truths.begin()].position;
      EXPECT_LT((add.landmark.position - truth).norm(), 0.05 * truth.norm());
      EXPECT_GT(add.landmark.reference_distance, 1);
      EXPECT_NEAR(add.landmark.view_direction.norm(), 1, 1e-9);
    }
    EXPECT_EQ(wrong, 0U);
    scene.map.Apply(edit);
    scene.map.CheckInvariants();
  }
}

// The same map in another unit.
Map Rescaled(Map map, double factor) {
  MapEdit edit;
  for (const auto& [id, keyframe] : map.keyframes()) {
    Rigid3 pose = keyframe.frame.cam_from_world;
    pose.translation *= factor;
    edit.push_back(edit::SetPose{id, pose});
  }
  for (const auto& [id, point] : map.points()) {
    edit.push_back(edit::MovePoint{id, factor * point.position});
  }
  map.Apply(edit);
  return map;
}

TEST(CreatePointsFromViews, WorksInAnyUnit) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 0);
  const TrueMap scene = WithFreeFeatures(world, {PoseOnPath(0), PoseOnPath(25)}, kMono);
  const auto metric =
      Only<edit::AddPoint>(CreatePointsFromViews(scene.map, world.Imaging(), KeyFrameId{1}, {}));
  ASSERT_GT(metric.size(), 80U);
  for (const double factor : {0.01, 100.0}) {
    const auto scaled = Only<edit::AddPoint>(
        CreatePointsFromViews(Rescaled(scene.map, factor), world.Imaging(), KeyFrameId{1}, {}));
    ASSERT_EQ(scaled.size(), metric.size()) << factor;
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      const Eigen::Vector3d position = scaled[i].landmark.position / factor;
      EXPECT_LT((position - metric[i].landmark.position).norm(), 1e-3) << factor;
    }
  }
}

TEST(CreatePointsFromViews, NeedsParallax) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 0);
  // Turned, not moved.
  const Rigid3 turned{ExpSo3({0, 0.05, 0.01}), Eigen::Vector3d(0.005, 0, 0)};
  const TrueMap scene = WithFreeFeatures(world, {Rigid3{}, turned}, kMono);
  EXPECT_TRUE(CreatePointsFromViews(scene.map, world.Imaging(), KeyFrameId{1}, {}).empty());
}

TEST(CreatePointsFromViews, WorksWhenTheCameraMovesForward) {
  // The nearest place that a feature may show lies behind the second camera.
  const SyntheticWorld world = MakeSyntheticWorld(600, 0);
  const Rigid3 ahead{Eigen::Quaterniond::Identity(), {0, 0, -1}};
  const TrueMap scene = WithFreeFeatures(world, {ahead, Rigid3{}}, kMono);
  EXPECT_GT(CreatePointsFromViews(scene.map, world.Imaging(), KeyFrameId{1}, {}).size(), 30U);
  const TrueMap forward = WithFreeFeatures(world, {Rigid3{}, ahead}, kMono);
  EXPECT_GT(CreatePointsFromViews(forward.map, world.Imaging(), KeyFrameId{1}, {}).size(), 30U);
}

TEST(CreateLinesFromViews, ReconstructsFromAllViews) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 300);
  TrueMap scene = WithFreeFeatures(world, {PoseOnPath(0), PoseOnPath(15), PoseOnPath(30)}, kMono);
  const KeyFrameId id{2};
  const MapEdit edit = CreateLinesFromViews(scene.map, world.Imaging(), id, {});
  const auto lines = Only<edit::AddLine>(edit);
  EXPECT_EQ(lines.size(), edit.size());
  EXPECT_GT(lines.size(), 20U);
  std::size_t of_three = 0;
  std::size_t wrong = 0;
  std::size_t exact = 0;
  for (const auto& add : lines) {
    of_three += add.landmark.observations.size() == 3;
    const auto truths = Truths(scene, add.landmark, &SyntheticFrame::line_truth);
    wrong += truths.size() != 1;
    const Segment3& truth = world.lines[*truths.begin()].segment;
    exact += LineError(add.landmark.line, truth) < 0.05 * truth.start.norm();
    EXPECT_GT(add.landmark.line.direction.dot(truth.Direction()), 0.7);
    EXPECT_LT(add.landmark.start, add.landmark.end);
    EXPECT_NEAR(add.landmark.view_direction.norm(), 1, 1e-9);
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GT(of_three, lines.size() / 3);
  EXPECT_GT(exact, lines.size() * 8 / 10);
  scene.map.Apply(edit);
  scene.map.CheckInvariants();
}

// Where two cameras are not turned against each other, the gate on rotation leaves only lines that
// are parallel to the image, for only these keep their direction in it.
TEST(CreateLinesFromViews, MatchesAsTheLineOptionsSay) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 300);
  const Rigid3 aside{Eigen::Quaterniond::Identity(), {-0.6, 0, 0}};
  const TrueMap scene = WithFreeFeatures(world, {Rigid3{}, aside}, kMono);
  const auto count = [&](const LineSettings& lines) {
    return CreateLinesFromViews(scene.map, world.Imaging(), KeyFrameId{1}, lines).size();
  };
  const std::size_t usual = count({});
  LineSettings gate;
  gate.rotation_gate = true;
  EXPECT_LT(count(gate), usual / 2);
  LineSettings lengths;
  lengths.min_length_ratio = 0.99;
  EXPECT_LT(count(lengths), usual);
}

TEST(CreateLinesFromViews, DropsAViewThatContradictsTheOthers) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 150);
  const std::vector<Rigid3> poses{PoseOnPath(0), PoseOnPath(15), PoseOnPath(30)};
  TrueMap scene = WithFreeFeatures(world, poses, kMono);
  const std::size_t good =
      CreateLinesFromViews(scene.map, world.Imaging(), KeyFrameId{2}, {}).size();
  // The first keyframe is not where the map has it: its views fit no line of the other two.
  scene.map.Apply({edit::SetPose{
      KeyFrameId{0},
      ExpSe3((Vector6d() << 0.05, 0.06, -0.08, 0.3, -0.2, 0.2).finished()) * poses[0]}});
  const MapEdit edit = CreateLinesFromViews(scene.map, world.Imaging(), KeyFrameId{2}, {});
  std::size_t from_the_right_pair = 0;
  for (const auto& add : Only<edit::AddLine>(edit)) {
    from_the_right_pair +=
        add.landmark.observations.size() == 2 && add.landmark.observations.contains(KeyFrameId{1});
  }
  EXPECT_GT(from_the_right_pair, good / 2);
}

TEST(CreateLinesFromViews, RejectsLinesInTheEpipolarPlane) {
  // Lines along x seen by cameras displaced along x: the interpretation planes coincide.
  SyntheticWorld world = MakeSyntheticWorld(200, 0);
  Rng rng(5);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d start(rng.Uniform(-2, 0), rng.Uniform(-2, 2), rng.Uniform(4, 7));
    world.lines.push_back({{start, start + Eigen::Vector3d(1.5, 0, 0)}, RandomDescriptor(rng)});
  }
  const Rigid3 aside{Eigen::Quaterniond::Identity(), {-0.4, 0, 0}};
  const TrueMap scene = WithFreeFeatures(world, {Rigid3{}, aside}, kStereo);
  EXPECT_TRUE(CreateLinesFromViews(scene.map, world.Imaging(), KeyFrameId{1}, {}).empty());
  const Rigid3 above{Eigen::Quaterniond::Identity(), {0, -0.4, 0}};
  const TrueMap better = WithFreeFeatures(world, {Rigid3{}, above}, kStereo);
  EXPECT_GT(CreateLinesFromViews(better.map, world.Imaging(), KeyFrameId{1}, {}).size(), 10U);
}

}  // namespace
}  // namespace plumbline
