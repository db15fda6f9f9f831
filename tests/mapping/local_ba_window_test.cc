// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/local_ba_window.h"

#include "plumbline/map/covisibility.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/mapping/map_problem.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <functional>
#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const SensorModel kSensor{.noise = 0.5, .missed = 0};

std::vector<Rigid3> Path(int count, int step) {
  std::vector<Rigid3> poses;
  for (int i = 0; i < count; ++i) poses.push_back(PoseOnPath(i * step));
  return poses;
}

LocalBaWindow Window(const TrueMap& scene,
                     const SyntheticWorld& world,
                     std::int64_t centre,
                     const LocalBaWindowOptions& options) {
  return MakeLocalBaWindow(scene.map, world.Imaging(), KeyFrameId{centre}, {}, options);
}

std::set<KeyFrameId> Free(const LocalBaWindow& window) {
  std::set<KeyFrameId> ids;
  for (std::size_t i = 0; i < window.keyframes.size(); ++i) {
    if (!window.problem.poses[i].fixed) ids.insert(window.keyframes[i]);
  }
  return ids;
}

TEST(LocalBaWindow, IsConsistent) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 80);
  const TrueMap scene = MakeTrueMap(world, Path(6, 5), kSensor);
  const LocalBaWindow window = Window(scene, world, 5, {});
  const BaProblem& problem = window.problem;
  ASSERT_EQ(problem.poses.size(), window.keyframes.size());
  ASSERT_EQ(problem.points.size(), window.points.size());
  ASSERT_EQ(problem.lines.size(), window.lines.size());
  // By time, each once: what FixInconsistentPoses takes for granted.
  EXPECT_EQ(
      std::adjacent_find(window.keyframes.begin(), window.keyframes.end(), std::greater_equal<>()),
      window.keyframes.end());
  const Rigid3 world_from_window = Inverse(window.problem_from_world);
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    EXPECT_EQ(problem.poses[i].follows, i > 0);
    const Rigid3 pose = problem.poses[i].cam_from_world * window.problem_from_world;
    const Rigid3& expected = scene.map.Find(window.keyframes[i])->frame.cam_from_world;
    EXPECT_LT(LogSe3(pose * Inverse(expected)).norm(), 1e-9);
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    EXPECT_LT(
        (world_from_window * problem.points[i] - scene.map.Find(window.points[i])->position).norm(),
        1e-9);
  }
  std::vector<int> views(problem.points.size());
  for (const auto& o : problem.point_observations) ++views[static_cast<std::size_t>(o.point)];
  EXPECT_TRUE(std::all_of(views.begin(), views.end(), [](int n) { return n >= 2; }));
  EXPECT_GT(window.lines.size(), 10U);
  // Centre: the window's world is its camera.
  const auto centre = std::find(window.keyframes.begin(), window.keyframes.end(), KeyFrameId{5});
  ASSERT_NE(centre, window.keyframes.end());
  const auto index = static_cast<std::size_t>(centre - window.keyframes.begin());
  EXPECT_LT(LogSe3(problem.poses[index].cam_from_world).norm(), 1e-9);
}

// Every other line is upright.
SyntheticWorld WorldWithUprightLines() {
  SyntheticWorld world = MakeSyntheticWorld(300, 120);
  for (std::size_t i = 0; i < world.lines.size(); i += 2) {
    Segment3& segment = world.lines[i].segment;
    segment.end = segment.start + Eigen::Vector3d(0, 2, 0);
  }
  return world;
}

TEST(LocalBaWindow, HoldsTheUprightLinesParallel) {
  const SyntheticWorld world = WorldWithUprightLines();
  const TrueMap scene = MakeTrueMap(world, Path(9, 12), kSensor);
  const LocalBaWindow window = Window(scene, world, 8, {});
  std::set<LineId> upright;
  for (const auto& [i, id] : scene.line_of) {
    if (i % 2 == 0) upright.insert(id);
  }
  ASSERT_EQ(window.problem.axes.size(), 1U);
  const Eigen::Vector3d axis =
      Inverse(window.problem_from_world).rotation * window.problem.axes.front();
  EXPECT_GT(std::abs(axis.y()), std::cos(0.005));
  ASSERT_GT(window.problem.parallel_lines.size(), 10U);
  std::ptrdiff_t right = 0;
  for (const auto& line : window.problem.parallel_lines) {
    EXPECT_EQ(line.axis, 0);
    right += upright.contains(window.lines[static_cast<std::size_t>(line.line)]) ? 1 : 0;
  }
  EXPECT_GE(right + 1, std::ssize(window.problem.parallel_lines));
  // All of them have what one has: 0.2 deg and the share in the error of the axis.
  const double sigma = window.problem.parallel_lines.front().sigma;
  EXPECT_GT(sigma, 0.0035);
  EXPECT_LT(sigma, 0.05);
}

TEST(LocalBaWindow, HoldsNoLinesParallelUnlessAskedTo) {
  const SyntheticWorld world = WorldWithUprightLines();
  const TrueMap scene = MakeTrueMap(world, Path(9, 12), kSensor);
  for (const bool parallel : {true, false}) {
    const LocalBaWindow window = MakeLocalBaWindow(
        scene.map, world.Imaging(), KeyFrameId{8}, {}, {.parallel_lines = parallel});
    EXPECT_EQ(window.problem.parallel_lines.empty(), !parallel);
  }
}

TEST(LocalBaWindow, IsCompletedByTheMethodOfItsLines) {
  const SyntheticWorld world = MakeSyntheticWorld(100, 20);
  const TrueMap scene = MakeTrueMap(world, Path(4, 5), kSensor);
  LineSettings lines;
  lines.weighting = LineWeighting::kNone;
  lines.method.complete_window = [](const LineWeights& weights, BaProblem& problem) {
    EXPECT_EQ(weights.kind, LineWeighting::kNone);
    EXPECT_FALSE(problem.lines.empty());
    problem.line_observations.front().measurement.covariance *= 7;
  };
  const LocalBaWindow window =
      MakeLocalBaWindow(scene.map, world.Imaging(), KeyFrameId{3}, lines, {});
  const Eigen::Matrix2d seven = 7 * Eigen::Matrix2d::Identity();
  EXPECT_EQ(window.problem.line_observations.front().measurement.covariance, seven);
}

TEST(LocalBaWindow, FixesTheFirstKeyFrameOfTheMap) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  const TrueMap scene = MakeTrueMap(world, Path(4, 5), kSensor);
  const LocalBaWindow window = Window(scene, world, 3, {});
  EXPECT_EQ(Free(window), (std::set<KeyFrameId>{{1}, {2}, {3}}));
  EXPECT_EQ(window.keyframes.size(), 4U);
}

TEST(LocalBaWindow, FreesTheClosestAndFixesTheRest) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  const TrueMap scene = MakeTrueMap(world, Path(9, 5), kSensor);
  LocalBaWindowOptions options;
  options.free_keyframes = 3;
  options.fixed_keyframes = 2;
  const LocalBaWindow window = Window(scene, world, 8, options);
  EXPECT_EQ(Free(window).size(), 3U);
  EXPECT_TRUE(Free(window).contains(KeyFrameId{8}));
  EXPECT_EQ(window.keyframes.size(), 5U);
}

// The work of a keyframe does not grow with the number of others that see the same landmarks.
TEST(LocalBaWindow, IsBoundedHoweverManyKeyFramesSeeTheSame) {
  const SyntheticWorld world = MakeSyntheticWorld(60, 10);
  const TrueMap scene = MakeTrueMap(world, Path(90, 1), kSensor);
  ASSERT_GT(Covisible(scene.map, KeyFrameId{89}).size(), 80U);
  const LocalBaWindow window = Window(scene, world, 89, {});
  EXPECT_EQ(Free(window).size(), 12U);
  EXPECT_EQ(window.keyframes.size(), 32U);
  const auto snapshot = TakeSnapshot(scene.map, KeyFrameId{89});
  EXPECT_EQ(snapshot->cam_from_world.size(), static_cast<std::size_t>(kSnapshotKeyFrames));
}

TEST(LocalBaWindow, SomethingAlwaysHoldsTheGauge) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  const TrueMap scene = MakeTrueMap(world, Path(9, 5), kSensor);
  LocalBaWindowOptions options;
  options.free_keyframes = 3;
  options.fixed_keyframes = 0;
  const LocalBaWindow window = Window(scene, world, 8, options);
  EXPECT_EQ(window.keyframes.size(), 3U);
  EXPECT_EQ(Free(window).size(), 2U);
  EXPECT_FALSE(Free(window).contains(window.keyframes.front()));  // the oldest
}

TEST(LocalBaWindow, TwoPosesHoldTheScaleOfASingleCamera) {
  SyntheticWorld world = MakeSyntheticWorld(300, 40);
  world.camera.baseline = 0;
  const TrueMap scene = MakeTrueMap(world, Path(9, 5), {.depth = false, .missed = 0});
  LocalBaWindowOptions options;
  options.free_keyframes = 4;
  options.fixed_keyframes = 0;
  const LocalBaWindow window = Window(scene, world, 8, options);
  EXPECT_EQ(window.keyframes.size(), 4U);
  EXPECT_EQ(Free(window).size(), 2U);
  options.free_keyframes = 20;  // all of the map
  EXPECT_EQ(Free(Window(scene, world, 8, options)).size(), 8U);
}

TEST(LocalBaWindow, LeavesOutYoungLines) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 250);
  SensorModel mono = kSensor;
  mono.depth = false;
  const TrueMap scene = MakeTrueMap(world, Path(3, 12), mono);
  LocalBaWindowOptions options;
  options.min_line_plane_angle_deg = 3;
  options.max_line_relative_sigma = 1e-6;  // the angle decides
  const LocalBaWindow window = Window(scene, world, 2, options);
  EXPECT_GT(window.lines.size(), 5U);
  const auto& lines = scene.map.lines();
  const auto seen = static_cast<std::size_t>(std::count_if(
      lines.begin(), lines.end(), [](auto& l) { return l.second.observations.size() >= 2; }));
  EXPECT_GT(seen, window.lines.size() + 5);
  options.max_line_relative_sigma = 1;  // ends known well enough
  const std::size_t with_known_ends = Window(scene, world, 2, options).lines.size();
  EXPECT_GT(with_known_ends, window.lines.size());
  options.min_line_plane_angle_deg = 0;
  EXPECT_EQ(Window(scene, world, 2, options).lines.size(), seen);
}

// Everything but the first keyframe off by some centimetres.
void Disturb(Map& map, double scale) {
  Rng rng(8, "disturb");
  MapEdit edit;
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (id == KeyFrameId{0}) continue;
    Vector6d twist;
    twist << RandomVector<3>(rng, 0.004 * scale), RandomVector<3>(rng, 0.02 * scale);
    edit.push_back(edit::SetPose{id, ExpSe3(twist) * keyframe.frame.cam_from_world});
  }
  for (const auto& [id, point] : map.points()) {
    edit.push_back(edit::MovePoint{id, point.position + RandomVector<3>(rng, 0.03 * scale)});
  }
  map.Apply(edit);
}

TEST(ToEdit, BringsBackDisturbedPosesAndLandmarks) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 80);
  const std::vector<Rigid3> truth = Path(5, 6);
  TrueMap scene = MakeTrueMap(world, truth, kSensor);
  Disturb(scene.map, 1);
  EXPECT_GT(WorstPose(scene.map, truth), 0.02);
  const LocalBaWindow window = Window(scene, world, 4, {});
  const BaResult result = SolveLocalBa(window.problem, {});
  EXPECT_LT(result.final_cost, 0.2 * result.initial_cost);
  scene.map.Apply(ToEdit(scene.map, world.Imaging(), window, result));
  scene.map.CheckInvariants();
  EXPECT_LT(WorstPose(scene.map, truth), 0.01);
  EXPECT_EQ(LogSe3(scene.map.Find(KeyFrameId{0})->frame.cam_from_world).norm(), 0);
  // What is written back is where the next window starts.
  const LocalBaWindow again = Window(scene, world, 4, {});
  const BaResult second = SolveLocalBa(again.problem, {});
  EXPECT_NEAR(second.initial_cost, result.final_cost, 0.05 * result.final_cost);
}

double MedianDistance(const Map& map) {
  std::vector<double> distances;
  for (const auto& [id, point] : map.points()) distances.push_back(point.position.norm());
  std::nth_element(distances.begin(),
                   distances.begin() + static_cast<int>(distances.size() / 2),
                   distances.end());
  return distances[distances.size() / 2];
}

TEST(ToEdit, KeepsTheScaleOfAMapWithoutDepth) {
  SyntheticWorld world = MakeSyntheticWorld(300, 80);
  world.camera.baseline = 0;
  TrueMap scene = MakeTrueMap(world, Path(5, 6), {.depth = false, .missed = 0});
  Disturb(scene.map, 0.3);
  const double before = MedianDistance(scene.map);
  for (int i = 0; i < 5; ++i) {
    const LocalBaWindow window = Window(scene, world, 4, {});
    const BaResult result = SolveLocalBa(window.problem, {});
    EXPECT_LT(result.final_cost, result.initial_cost + 1e-9);
    scene.map.Apply(ToEdit(scene.map, world.Imaging(), window, result));
  }
  EXPECT_NEAR(MedianDistance(scene.map) / before, 1, 0.03);
}

TEST(ToEdit, RemovesObservationsThatDoNotFit) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  const std::vector<Rigid3> truth = Path(5, 6);
  TrueMap scene = MakeTrueMap(world, truth, kSensor);
  // Two often seen points exchange their features in one keyframe.
  std::vector<PointId> often;
  for (const auto& [id, point] : scene.map.points()) {
    if (point.observations.size() == 5) often.push_back(id);
  }
  ASSERT_GT(often.size(), 2U);
  const PointId a = often.front();
  const PointId b = often.back();
  const int feature_a = scene.map.Find(a)->observations.at(KeyFrameId{3});
  const int feature_b = scene.map.Find(b)->observations.at(KeyFrameId{3});
  scene.map.Apply({edit::RemovePointObservation{a, KeyFrameId{3}},
                   edit::RemovePointObservation{b, KeyFrameId{3}},
                   edit::AddPointObservation{a, KeyFrameId{3}, feature_b},
                   edit::AddPointObservation{b, KeyFrameId{3}, feature_a}});
  const LocalBaWindow window = Window(scene, world, 4, {});
  const BaResult result = SolveLocalBa(window.problem, {});
  scene.map.Apply(ToEdit(scene.map, world.Imaging(), window, result));
  scene.map.CheckInvariants();
  for (const PointId id : {a, b}) {
    ASSERT_NE(scene.map.Find(id), nullptr);
    EXPECT_FALSE(scene.map.Find(id)->observations.contains(KeyFrameId{3}));
    EXPECT_EQ(scene.map.Find(id)->observations.size(), 4U);
  }
}

TEST(ToEdit, LinesAreRefitWithoutTheObservationsThatGo) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 60);
  TrueMap scene = MakeTrueMap(world, Path(5, 6), kSensor);
  // A line seen by all takes a feature of a far away line in one keyframe.
  LineId victim;
  LineId other;
  for (const auto& [id, line] : scene.map.lines()) {
    if (line.observations.size() == 5) (victim.valid() ? other : victim) = id;
  }
  ASSERT_TRUE(other.valid());
  const int wrong = scene.map.Find(other)->observations.at(KeyFrameId{2});
  scene.map.Apply({edit::RemoveLine{other},
                   edit::RemoveLineObservation{victim, KeyFrameId{2}},
                   edit::AddLineObservation{victim, KeyFrameId{2}, wrong}});
  const LocalBaWindow window = Window(scene, world, 4, {});
  const BaResult result = SolveLocalBa(window.problem, {});
  scene.map.Apply(ToEdit(scene.map, world.Imaging(), window, result));
  const MapLine& line = *scene.map.Find(victim);
  ASSERT_FALSE(line.observations.contains(KeyFrameId{2}));
  Eigen::Matrix4d expected = Eigen::Matrix4d::Zero();
  for (const auto& [id, feature] : line.observations) {
    expected += LineInformation(
        world.camera, scene.map.Find(id)->frame, static_cast<std::size_t>(feature), line.line);
  }
  EXPECT_LT((line.information - expected).norm(), 1e-6 * expected.norm());
}

TEST(RefitInterval, CoversWhatIsSeenAndKeepsTheDirection) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = MakeTrueMap(world, Path(5, 4), {.noise = 0, .missed = 0});
  int tested = 0;
  for (const auto& [index, id] : scene.line_of) {
    const MapLine& line = *scene.map.Find(id);
    const PluckerLine reversed{-line.line.moment, -line.line.direction};
    const edit::MoveLine change = RefitInterval(scene.map, world.Imaging(), {}, line, reversed);
    EXPECT_GT(change.line.direction.dot(line.line.direction), 0.999);
    EXPECT_LT(change.start, change.end);
    // Within the true segment, of which parts may be out of sight.
    EXPECT_GT(change.start, line.start - 1e-6);
    EXPECT_LT(change.end, line.end + 1e-6);
    EXPECT_LT((change.information - line.information).norm(), 1e-6 * line.information.norm());
    ++tested;
  }
  EXPECT_GT(tested, 20);
}

TEST(RefitInterval, OneOverlongSegmentAmongManyDoesNotLengthenTheLine) {
  SyntheticWorld world;
  world.lines.push_back({{{-0.5, -1, 5}, {0.5, 1, 5}}, {}});
  const std::vector<Rigid3> poses = Path(5, 4);
  TrueMap scene = MakeTrueMap(world, poses, {.noise = 0, .missed = 0});
  // One more keyframe with a segment of twice the length.
  SyntheticWorld longer = world;
  longer.lines[0].segment = {{-1, -2, 5}, {1, 2, 5}};
  Rng rng(1);
  const SyntheticFrame sensed = Sense(longer, poses[0], {.noise = 0, .missed = 0}, rng);
  const KeyFrameId id = AddKeyFrameTo(scene.map, poses[0], sensed);
  scene.map.Apply({edit::AddLineObservation{LineId{0}, id, 0}});
  const MapLine& line = *scene.map.Find(LineId{0});
  ASSERT_EQ(line.observations.size(), 6U);
  const edit::MoveLine change = RefitInterval(scene.map, world.Imaging(), {}, line, line.line);
  EXPECT_LE(change.end - change.start, world.lines[0].segment.Length() + 1e-6);
}

}  // namespace
}  // namespace plumbline
