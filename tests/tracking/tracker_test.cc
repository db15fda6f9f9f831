// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/tracker.h"

#include "plumbline/base/error.h"
#include "plumbline/mapping/local_mapper.h"

#include "tests/support/initial_map_of.h"
#include "tests/support/synthetic_run.h"
#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const SensorModel kPointsOnly{.lines = false};
const SensorModel kLinesOnly{.points = false};

SyntheticWorld World() { return MakeSyntheticWorld(500, 120); }

// Follows the path; the largest distance from the true position.
double FollowPath(SyntheticRun& run, int first, int last, const SensorModel& sensor) {
  double worst = 0;
  for (int i = first; i <= last; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), sensor);
    EXPECT_EQ(result.state, TrackerState::kTracking) << "frame " << i;
    EXPECT_EQ(result.failure, TrackingFailure::kNone) << "frame " << i;
    if (!result.cam_from_world) return 1e9;
    worst = std::max(worst, CentreDistance(*result.cam_from_world, PoseOnPath(i)));
  }
  return worst;
}

TEST(Tracker, FollowsASmoothPathWithPointsAndLines) {
  SyntheticRun run(World());
  EXPECT_LT(FollowPath(run, 0, 50, {}), 0.03);
  EXPECT_EQ(run.maps().size(), 1U);
}

TEST(Tracker, FollowsASmoothPathWithPointsOnly) {
  SyntheticRun run(World());
  EXPECT_LT(FollowPath(run, 0, 50, kPointsOnly), 0.03);
}

TEST(Tracker, FollowsASmoothPathWithLinesOnly) {
  SlamOptions options;
  options.tracking.min_initial = 20;
  SyntheticRun run(MakeSyntheticWorld(0, 200), options);
  EXPECT_LT(FollowPath(run, 0, 50, kLinesOnly), 0.05);
}

TEST(Tracker, FollowsASmoothPathWithCutLines) {
  SlamOptions options = SyntheticRun::InlineOptions();
  options.cutting.method = "greedy";
  SyntheticRun run(World(), options);
  EXPECT_LT(FollowPath(run, 0, 30, {}), 0.04);  // a little more than whole lines
}

TEST(Tracker, FollowsTheLastFrameAlone) {
  SlamOptions options = SyntheticRun::InlineOptions();
  options.tracking.reference = TrackingReference::kLastFrame;
  SyntheticRun run(World(), options);
  for (int i = 0; i <= 30; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), {});
    ASSERT_TRUE(result.cam_from_world) << i;
    // Errors add up, as nothing is kept.
    EXPECT_LT(CentreDistance(*result.cam_from_world, PoseOnPath(i)), 0.1) << i;
    EXPECT_EQ(result.keyframe.has_value(), i == 0);
    EXPECT_EQ(result.reference, KeyFrameId{0});
    const auto of_map = [](auto id) { return id.valid(); };
    EXPECT_TRUE(std::none_of(result.frame.points.begin(), result.frame.points.end(), of_map));
    EXPECT_TRUE(std::none_of(result.frame.lines.begin(), result.frame.lines.end(), of_map));
    if (i > 0) {
      EXPECT_GT(result.counts.inlier_points, 50);
      EXPECT_GT(result.counts.inlier_lines, 10);
    }
  }
  EXPECT_EQ(run.maps().at(MapId{0}).keyframes().size(), 1U);
  // What looks like the last frame is found again, where the prediction does not lead.
  for (int i = 31; i <= 33; ++i) EXPECT_FALSE(run.StepBlind().cam_from_world);
  const TrackingResult back = run.Step(PoseOnPath(32), {});
  ASSERT_TRUE(back.cam_from_world);
  EXPECT_LT(CentreDistance(*back.cam_from_world, PoseOnPath(32)), 0.1);
}

// Distance from the true position after a body has moved before the camera for a while, nearer than
// the rest of the world and with as many points.
double ErrorBehindAMovingBody(int established_views) {
  constexpr int kAppears = 10, kLast = 40;
  SlamOptions options = SyntheticRun::InlineOptions();
  options.tracking.established_views = established_views;
  const SyntheticWorld world = MakeSyntheticWorld(500, 0);
  SyntheticRun run(world, options);
  Rng rng(3, "body");
  std::vector<SyntheticWorld::Point> body;
  for (int i = 0; i < 200; ++i) {
    const double x = rng.Uniform(-1, 0.6);
    const double y = rng.Uniform(-0.7, 0.7);
    body.push_back({{x, y, rng.Uniform(1.8, 2)}, RandomDescriptor(rng)});
  }
  double error = 0;
  for (int i = 0; i <= kLast; ++i) {
    SyntheticWorld today = world;
    for (SyntheticWorld::Point point : body) {
      point.position.x() += 0.02 * (i - kAppears);
      if (i >= kAppears) today.points.push_back(point);
    }
    Rng noise(1, "synthetic_run", static_cast<std::uint64_t>(i));
    const TrackingResult result = run.Step(Sense(today, PoseOnPath(i), {}, noise));
    if (!result.cam_from_world) return 1e9;
    error = CentreDistance(*result.cam_from_world, PoseOnPath(i));
  }
  return error;
}

TEST(Tracker, IsNotMovedByABodyThatIsNearAndMoves) {
  EXPECT_LT(ErrorBehindAMovingBody(3), 0.02);
  EXPECT_GT(ErrorBehindAMovingBody(0), 0.1) << "the body says nothing wrong here";
}

TEST(Tracker, ExactMeasurementsGiveExactPoses) {
  SyntheticRun run(World());
  EXPECT_LT(FollowPath(run, 0, 20, {.noise = 0}), 1e-4);
}

TEST(Tracker, TheFirstFrameIsTheFirstKeyFrameAtTheGivenPose) {
  const SyntheticWorld world = World();
  const Rigid3 world_from_cam{ExpSo3({0.1, 0.2, -0.3}), {1, 2, 3}};
  Tracker tracker(world.Imaging(), {}, {world.camera, {}, {}}, world_from_cam);
  EXPECT_EQ(tracker.state(), TrackerState::kInitializing);
  Rng rng(1);
  const SyntheticFrame sensed = Sense(world, {}, {}, rng);
  const TrackingResult result = tracker.Track(FrameId{7}, 123, sensed.indexed, nullptr);
  ASSERT_TRUE(result.keyframe);
  EXPECT_TRUE(result.starts_map);
  EXPECT_EQ(result.keyframe->keyframe.id, KeyFrameId{0});
  EXPECT_FALSE(result.keyframe->keyframe.parent.valid());
  EXPECT_EQ(result.keyframe->keyframe.frame.id, FrameId{7});
  EXPECT_EQ(result.keyframe->keyframe.frame.stamp_ns, 123);
  EXPECT_LT(LogSe3(*result.cam_from_world * world_from_cam).norm(), 1e-12);
  EXPECT_EQ(result.reference, KeyFrameId{0});
  EXPECT_EQ(tracker.state(), TrackerState::kTracking);
  EXPECT_THROW(tracker.Track(FrameId{8}, 124, sensed.indexed, nullptr), BugError);
}

// Starts a run of a single camera from frames 0, 8 and 16 of the path.
void StartFromThree(const SyntheticWorld& world, SyntheticRun& run) {
  const TrackingResult start = run.Start(InitialMapOf(world, {0, 8, 16}), Vector6d::Zero());
  EXPECT_EQ(start.state, TrackerState::kTracking);
  EXPECT_EQ(start.reference, KeyFrameId{2});
  EXPECT_GT(start.counts.inlier_points, 100);
  EXPECT_FALSE(start.keyframe);
  EXPECT_LT(CentreDistance(*start.cam_from_world, InMapUnit(PoseOnPath(16))) * kMapUnit, 0.01);
}

TEST(Tracker, GoesOnFromAMapOfSeveralFramesWithoutDepth) {
  const SyntheticWorld world = MakeMonocularWorld(500, 120);
  SyntheticRun run(world);
  StartFromThree(world, run);
  for (int i = 17; i < 60; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), kOneCamera);
    ASSERT_TRUE(result.cam_from_world) << i;
    EXPECT_LT(CentreDistance(*result.cam_from_world, InMapUnit(PoseOnPath(i))) * kMapUnit, 0.03)
        << i;
  }
  EXPECT_EQ(run.maps().size(), 1U);
  EXPECT_GT(run.maps().at(MapId{0}).keyframes().size(), 4U);
}

TEST(Tracker, GivesUpAYoungMapOfASingleCameraAtOnce) {
  const SyntheticWorld world = MakeMonocularWorld(500, 120);
  SyntheticRun young(world);
  StartFromThree(world, young);
  young.Step(PoseOnPath(17), kOneCamera);
  EXPECT_EQ(young.StepBlind().state, TrackerState::kInitializing);

  SlamOptions trusting = SyntheticRun::InlineOptions();
  trusting.tracking.trial_keyframes = 0;
  SyntheticRun trusted(world, trusting);
  StartFromThree(world, trusted);
  trusted.Step(PoseOnPath(17), kOneCamera);
  EXPECT_EQ(trusted.StepBlind().state, TrackerState::kLost);
  EXPECT_EQ(trusted.Step(PoseOnPath(19), kOneCamera).state, TrackerState::kTracking);
}

TEST(Tracker, LeavesAMapThatWasWithdrawnAtOnce) {
  const SyntheticWorld world = MakeMonocularWorld(300, 60);
  SlamOptions options = SyntheticRun::InlineOptions();
  options.tracking.trial_keyframes = 0;
  MapperThread stage(world.Imaging(), options);
  stage.Submit(16,
               MakeInitialMapEdit(
                   InitialMapOf(world, {0, 8, 16}), world.Imaging(), Rigid3{}, KeyFrameId{0}));
  const auto snapshot = stage.SnapshotFor(16);
  const PoseEstimator estimator(world.camera, {options.lines}, {options.cutting});
  Tracker tracker(world.Imaging(), options.tracking, estimator, Rigid3{});
  tracker.StartFrom(*snapshot, Vector6d::Zero());
  const auto track = [&](int frame, const MapSnapshot& seen) {
    Rng rng(1, "withdrawn", static_cast<std::uint64_t>(frame));
    const SyntheticFrame sensed = Sense(world, PoseOnPath(frame), kOneCamera, rng);
    return tracker.Track(FrameId{frame}, 50'000'000 * frame, sensed.indexed, &seen);
  };
  EXPECT_TRUE(track(17, *snapshot).cam_from_world);
  MapSnapshot withdrawn = *snapshot;
  withdrawn.withdrawn = true;
  const TrackingResult result = track(18, withdrawn);
  EXPECT_FALSE(result.cam_from_world);
  EXPECT_EQ(result.failure, TrackingFailure::kMapWithdrawn);
  EXPECT_EQ(result.state, TrackerState::kInitializing);
}

TEST(Tracker, DoesNotStartAMapWithTooLittle) {
  SyntheticRun run(MakeSyntheticWorld(40, 0));  // some half of them in view
  for (int i = 0; i < 15; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), {});
    EXPECT_EQ(result.state, TrackerState::kInitializing);
    EXPECT_EQ(result.failure, TrackingFailure::kTooFewFeatures);
    EXPECT_FALSE(result.cam_from_world);
    EXPECT_FALSE(result.keyframe);
  }
  EXPECT_TRUE(run.maps().empty());
}

TEST(Tracker, ReportsPosesRelativeToTheReference) {
  SyntheticRun run(World());
  for (int i = 0; i < 30; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), {});
    ASSERT_TRUE(result.cam_from_world);
    if (result.keyframe) {
      EXPECT_EQ(result.reference, result.keyframe->keyframe.id);
      EXPECT_LT(LogSe3(result.from_reference.cam_from_keyframe).norm(), 1e-12);
    }
    EXPECT_GE(result.counts.matched_points, result.counts.inlier_points);
    EXPECT_GE(result.counts.matched_lines, result.counts.inlier_lines);
    if (i > 0) {
      EXPECT_GT(result.counts.inlier_points, 100);
      EXPECT_GT(result.counts.inlier_lines, 15);
    }
  }
}

TEST(Tracker, RecoversAfterABlackout) {
  SyntheticRun run(World());
  FollowPath(run, 0, 20, {});
  for (int i = 21; i <= 25; ++i) {
    const TrackingResult result = run.StepBlind();
    EXPECT_EQ(result.state, TrackerState::kLost);
    EXPECT_EQ(result.failure, TrackingFailure::kTooFewFeatures);
    EXPECT_FALSE(result.cam_from_world);
    EXPECT_FALSE(result.keyframe);
  }
  EXPECT_LT(FollowPath(run, 26, 45, {}), 0.03);
  EXPECT_EQ(run.maps().size(), 1U);
}

TEST(Tracker, RecoversWhereItLooksLikeTheLastKeyFrame) {
  // Back at the keyframe after a blackout, though the prediction is far off.
  SyntheticRun run(World());
  FollowPath(run, 0, 12, {});
  run.StepBlind();
  const Rigid3 away = ExpSe3((Vector6d() << 0, 0.12, 0.1, 0.2, 0, 0).finished()) * PoseOnPath(12);
  const TrackingResult result = run.Step(away, {});
  ASSERT_TRUE(result.cam_from_world);
  EXPECT_LT(CentreDistance(*result.cam_from_world, away), 0.03);
}

// Sideways, so that what repeats on a wall of 4 m lies where its neighbour was.
constexpr double kPeriod = 0.3;

SyntheticWorld WallWithAPattern() {
  SyntheticWorld world = MakeSyntheticWorld(500, 0);
  Rng rng(5, "pattern");
  for (int row = -2; row <= 2; ++row) {
    const Descriptor descriptor = RandomDescriptor(rng);
    for (int column = -8; column <= 8; ++column) {
      world.points.push_back({{kPeriod * column, 0.25 * row, 4}, descriptor});
    }
  }
  return world;
}

Rigid3 MovedSideways(double x) { return {Eigen::Quaterniond::Identity(), {-x, 0, 0}}; }

TEST(Tracker, TakesNoPatternForTheSameBeforeItKnowsTheMotion) {
  SyntheticRun run(WallWithAPattern());
  run.Step(MovedSideways(0), kPointsOnly);
  const TrackingResult result = run.Step(MovedSideways(kPeriod), kPointsOnly);
  ASSERT_TRUE(result.cam_from_world);
  EXPECT_LT(CentreDistance(*result.cam_from_world, MovedSideways(kPeriod)), 0.03);
}

TEST(Tracker, TakesNoPatternForTheSameAfterASuddenMotion) {
  constexpr double kStep = 0.01;
  constexpr int kSteps = 10;
  SyntheticRun run(WallWithAPattern());
  for (int i = 0; i < kSteps; ++i) run.Step(MovedSideways(kStep * i), kPointsOnly);
  const Rigid3 there = MovedSideways(kStep * kSteps + kPeriod);
  const TrackingResult result = run.Step(there, kPointsOnly);
  ASSERT_TRUE(result.cam_from_world);
  EXPECT_LT(CentreDistance(*result.cam_from_world, there), 0.03);
}

TEST(Tracker, StartsANewMapAfterTooManyLostFrames) {
  SlamOptions options = SyntheticRun::InlineOptions();
  options.tracking.new_map_after = 4;
  options.loop.enabled = false;  // or the new map would be joined with the old one
  SyntheticRun run(World(), options);
  FollowPath(run, 0, 10, {});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(run.StepBlind().state, TrackerState::kLost);
  EXPECT_EQ(run.StepBlind().state, TrackerState::kInitializing);
  const TrackingResult restart = run.Step(PoseOnPath(15), {});
  EXPECT_TRUE(restart.starts_map);
  ASSERT_TRUE(restart.keyframe);
  EXPECT_FALSE(restart.keyframe->keyframe.parent.valid());
  EXPECT_LT(LogSe3(*restart.cam_from_world).norm(), 1e-12);
  // From there on poses are relative to where the new map began.
  for (int i = 16; i < 30; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), {});
    ASSERT_TRUE(result.cam_from_world);
    EXPECT_LT(CentreDistance(*result.cam_from_world, PoseOnPath(i) * Inverse(PoseOnPath(15))),
              0.02);
  }
  ASSERT_EQ(run.maps().size(), 2U);
  EXPECT_EQ(run.maps().at(MapId{1}).id(), MapId{1});
  run.maps().at(MapId{1}).CheckInvariants();
}

TEST(Tracker, ReportsWhenTooFewMatchesAgree) {
  SyntheticRun run(World());
  FollowPath(run, 0, 5, {});
  // The same landmarks, each of them somewhere else in the image.
  Rng rng(3);
  const SyntheticFrame sensed = Sense(World(), PoseOnPath(6), {}, rng);
  Features features = sensed.indexed->features;
  for (PointFeature& point : features.points) {
    point.px = {rng.Uniform(0, 751), rng.Uniform(0, 479)};
  }
  features.lines.clear();
  features.line_right.clear();
  const TrackingResult result = run.Step({IndexFeatures(TestCamera(), features), {}, {}});
  EXPECT_EQ(result.state, TrackerState::kLost);
  EXPECT_EQ(result.failure, TrackingFailure::kTooFewInliers);
}

// A tracker with one keyframe in a map whose contents the test may change.
struct OneKeyFrame {
  SyntheticWorld world = World();
  Tracker tracker{world.Imaging(), {}, {world.camera, {}, {}}, Rigid3{}};
  Map map;
  Rng rng{2};

  OneKeyFrame() {
    const TrackingResult start =
        tracker.Track(FrameId{0}, 0, Sense(world, PoseOnPath(0), {}, rng).indexed, nullptr);
    // All depths that are any good make landmarks, so that there are many to track.
    MappingOptions options;
    options.creation.max_relative_depth_sigma = 0.1;
    options.creation.max_relative_line_depth_sigma = 0.1;
    LocalMapper mapper(world.Imaging(), {}, options);
    mapper.Add(map, start.keyframe->keyframe, start.keyframe->scores);
  }
  TrackingResult Step(int i) {
    const auto snapshot = TakeSnapshot(map, KeyFrameId{0}, 40);
    return tracker.Track(
        FrameId{i}, i, Sense(world, PoseOnPath(i), {}, rng).indexed, snapshot.get());
  }
};

TEST(Tracker, WantsRightLinesOfKeyFramesAndWhereItKnowsLittle) {
  OneKeyFrame scene;
  EXPECT_TRUE(scene.tracker.NeedsRightLines());  // how well the first pose is known is not told
  TrackingResult result = scene.Step(1);
  ASSERT_TRUE(result.cam_from_world);
  ASSERT_FALSE(result.keyframe);
  EXPECT_TRUE(scene.tracker.NeedsRightLines());
  EXPECT_TRUE(scene.tracker.WantsRightLines(result));
  // The next frame comes so soon that its pose is known by both frames.
  result = scene.Step(2);
  ASSERT_FALSE(result.keyframe);
  EXPECT_FALSE(scene.tracker.NeedsRightLines());
  EXPECT_FALSE(scene.tracker.WantsRightLines(result));
  result.keyframe.emplace();
  EXPECT_TRUE(scene.tracker.WantsRightLines(result));
  result.cam_from_world.reset();
  EXPECT_FALSE(scene.tracker.WantsRightLines(result));
}

TEST(Tracker, KeepsRightLinesThatComeLater) {
  OneKeyFrame scene;
  TrackingResult result = scene.Step(1);
  result.keyframe.emplace();
  const auto whole = std::make_shared<const FrameFeatures>(*result.frame.indexed);
  scene.tracker.Complete(whole, result);
  EXPECT_EQ(result.frame.indexed, whole);
  EXPECT_EQ(result.keyframe->keyframe.frame.indexed, whole);
}

TEST(Tracker, NeedsRightLinesToStartAMapAndForOdometry) {
  const SyntheticWorld world = World();
  const Tracker fresh(world.Imaging(), {}, {world.camera, {}, {}}, Rigid3{});
  EXPECT_TRUE(fresh.NeedsRightLines());
  CameraAndPyramid one_camera = world.Imaging();
  one_camera.camera.baseline = 0;
  EXPECT_FALSE(Tracker(one_camera, {}, {one_camera.camera, {}, {}}, Rigid3{}).NeedsRightLines());
  TrackingOptions odometry;
  odometry.reference = TrackingReference::kLastFrame;
  Tracker follows(world.Imaging(), odometry, {world.camera, {}, {}}, Rigid3{});
  Rng rng(2);
  const TrackingResult first =
      follows.Track(FrameId{0}, 0, Sense(world, PoseOnPath(0), {}, rng).indexed, nullptr);
  EXPECT_TRUE(follows.NeedsRightLines());
  EXPECT_FALSE(follows.WantsRightLines(first));
}

TEST(Tracker, WaitsWithANewMapWhereItIsToldTo) {
  for (const double seconds : {0.0, 1.0}) {
    const SyntheticWorld world = World();
    Tracker tracker(world.Imaging(), {}, {world.camera, {}, {}}, Rigid3{}, {seconds, 0});
    Rng rng(1);
    Map map;
    const TrackingResult start =
        tracker.Track(FrameId{0}, 0, Sense(world, PoseOnPath(0), {}, rng).indexed, nullptr);
    LocalMapper mapper(world.Imaging(), {}, MappingOptions{});
    mapper.Add(map, start.keyframe->keyframe, start.keyframe->scores);
    const auto snapshot = TakeSnapshot(map, KeyFrameId{0});
    int lost = 0;
    while (tracker.state() != TrackerState::kInitializing) {
      ++lost;
      tracker.Track(
          FrameId{lost}, 50'000'000 * lost, IndexFeatures(world.camera, {}), snapshot.get());
    }
    EXPECT_EQ(lost, seconds == 0 ? TrackingOptions{}.new_map_after : 20);
  }
}

// Share of the features with a landmark of the map, of those that could have one.
TEST(Tracker, PrefersLandmarksOfTheMapToThoseMadeOnTheSpot) {
  OneKeyFrame scene;
  for (int i = 1; i < 4; ++i) {
    const TrackingResult result = scene.Step(i);
    int of_map = 0;
    for (const PointId id : result.frame.points) of_map += id.valid();
    int lines_of_map = 0;
    for (const LineId id : result.frame.lines) lines_of_map += id.valid();
    EXPECT_GT(of_map, result.counts.inlier_points * 8 / 10) << "frame " << i;
    // Mapping asks for better depths, so that some lines are only made on the spot.
    EXPECT_GT(lines_of_map, result.counts.inlier_lines * 4 / 10) << "frame " << i;
  }
}

TEST(Tracker, LetsGoOfLandmarksThatTheMapRemoved) {
  OneKeyFrame scene;
  const TrackingResult before = scene.Step(1);
  std::set<PointId> removed_points;
  std::set<LineId> removed_lines;
  MapEdit edit;
  for (std::size_t i = 0; i < before.frame.points.size(); i += 2) {
    const PointId id = before.frame.points[i];
    if (id.valid() && removed_points.insert(id).second) edit.push_back(edit::RemovePoint{id});
  }
  for (std::size_t i = 0; i < before.frame.lines.size(); i += 2) {
    const LineId id = before.frame.lines[i];
    if (id.valid() && removed_lines.insert(id).second) edit.push_back(edit::RemoveLine{id});
  }
  ASSERT_GT(removed_points.size(), 50U);
  ASSERT_GT(removed_lines.size(), 5U);
  scene.map.Apply(edit);
  const TrackingResult after = scene.Step(2);
  ASSERT_TRUE(after.cam_from_world);
  for (const PointId id : after.frame.points) EXPECT_FALSE(removed_points.contains(id)) << id.value;
  for (const LineId id : after.frame.lines) EXPECT_FALSE(removed_lines.contains(id)) << id.value;
}

TEST(Tracker, FollowsLandmarksThatTheMapMerged) {
  // Two points of the map at one place, of which the frame before showed the one that goes.
  OneKeyFrame scene;
  const TrackingResult before = scene.Step(1);
  std::size_t feature = 0;
  while (!before.frame.points[feature].valid()) ++feature;
  const PointId gone = before.frame.points[feature];
  MapPoint twin = *scene.map.Find(gone);
  const PointId kept = scene.map.NextPointId();
  twin.id = kept;
  MapEdit edit{edit::AddPoint{twin}};  // takes over the observation, by which the first one goes
  scene.map.Apply(edit);
  ASSERT_EQ(scene.map.Find(gone), nullptr);
  for (int i = 2; i < 6; ++i) {
    const TrackingResult after = scene.Step(i);
    for (const PointId id : after.frame.points) EXPECT_NE(id, gone);
  }
}

TEST(Tracker, ScoresWhatItExpectsAndFinds) {
  SyntheticRun run(World());
  bool seen = false;
  for (int i = 0; i < 40; ++i) {
    const TrackingResult result = run.Step(PoseOnPath(i), {});
    if (!result.keyframe || i == 0) continue;
    seen = true;
    int visible = 0;
    int found = 0;
    for (const auto& [id, score] : result.keyframe->scores.points) {
      EXPECT_TRUE(id.valid());
      EXPECT_LE(score.found, score.visible + 1) << id.value;
      visible += score.visible;
      found += score.found;
    }
    EXPECT_GT(visible, 200);
    // The sensor misses 5 % and the gates some more.
    EXPECT_GT(found, visible * 6 / 10);
    EXPECT_LE(found, visible);
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace plumbline
