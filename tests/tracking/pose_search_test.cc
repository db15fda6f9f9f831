// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/pose_search.h"

#include "tests/support/synthetic_world.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

struct KnownWorld {
  SyntheticWorld world = MakeSyntheticWorld(500, 100);
  TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(20)}, SensorModel{});
  std::shared_ptr<const MapSnapshot> snapshot = TakeSnapshot(scene.map, KeyFrameId{0}, 10);

  std::optional<PoseAttempt> Locate(const FrameFeatures& image, const Rigid3& predicted) const {
    return LocateFrame(world.Imaging(),
                       {world.camera, {}, {}},
                       image,
                       predicted,
                       *snapshot,
                       TrackingOptions{}.max_pose_sigma);
  }
};

TEST(LocateFrame, FindsAFrameFromARoughPrediction) {
  const KnownWorld known;
  for (const SensorModel& sensor : {SensorModel{}, SensorModel{.depth = false}}) {
    Rng rng(3);
    const SyntheticFrame sensed = Sense(known.world, PoseOnPath(8), sensor, rng);
    for (const double off : {0.0, 0.01, 0.05}) {  // 0.05 rad: some 20 px
      Vector6d twist = Vector6d::Zero();
      twist(1) = off;
      const auto located = known.Locate(*sensed.indexed, ExpSe3(twist) * PoseOnPath(8));
      ASSERT_TRUE(located) << off;
      EXPECT_LT(CentreDistance(located->pose.cam_from_world, PoseOnPath(8)), 0.02) << off;
      EXPECT_GT(located->counts.inlier_points, 100);
      EXPECT_GT(located->counts.inlier_lines, 5);
      EXPECT_LE(located->counts.inlier_points, located->counts.matched_points);
    }
  }
}

TEST(LocateFrame, DoesNotInventAPose) {
  const KnownWorld known;
  const SyntheticWorld other = [] {
    SyntheticWorld world = MakeSyntheticWorld(500, 100);
    Rng rng(99);
    for (auto& point : world.points) point.descriptor = RandomDescriptor(rng);
    for (auto& line : world.lines) line.descriptor = RandomDescriptor(rng);
    return world;
  }();
  Rng rng(3);
  EXPECT_FALSE(known.Locate(*Sense(other, PoseOnPath(8), {}, rng).indexed, PoseOnPath(8)));
  EXPECT_FALSE(known.Locate(*IndexFeatures(known.world.camera, {}), PoseOnPath(8)));
}

}  // namespace

namespace pose_search_test {

// A frame of the path with its features, and no matches yet.
Frame FrameAt(const SyntheticWorld& world, int step) {
  Rng rng(5, "pose_search", static_cast<std::uint64_t>(step));
  Frame frame;
  frame.indexed = Sense(world, PoseOnPath(step), {}, rng).indexed;
  frame.points.resize(frame.features().points.size());
  frame.lines.resize(frame.features().lines.size());
  return frame;
}

// The first frame of the path was tracked; the map has nothing.
struct Scene {
  SyntheticWorld world = MakeSyntheticWorld(400, 100);
  LastFrame last;
  MapSnapshot snapshot;
  TrackingOptions options;
  LandmarkMatches association;

  Scene() {
    last.frame = FrameAt(world, 0);
    last.frame.cam_from_world = PoseOnPath(0);
    last.association = LandmarkMatches(last.frame.points.size(), last.frame.lines.size());
    auto keyframe = std::make_shared<KeyFrame>();
    keyframe->frame = last.frame;
    snapshot.reference = keyframe;
    snapshot.cam_from_world[KeyFrameId{0}] = PoseOnPath(0);
  }

  PoseSearch Search() const { return {world.Imaging(), options, {world.camera, {}, {}}}; }
};

void ExpectPose(const std::optional<PoseEstimate>& pose, const Rigid3& truth) {
  ASSERT_TRUE(pose);
  EXPECT_LT(CentreDistance(pose->cam_from_world, truth), 0.03);
  EXPECT_GT(pose->inlier_points, 50);
  EXPECT_GT(pose->inlier_lines, 10);
}

TEST(PoseSearch, FollowsTheDepthsOfTheLastFrame) {
  Scene scene;
  const Frame frame = FrameAt(scene.world, 2);
  const auto pose = scene.Search().FromPrediction(
      frame, {PoseOnPath(1)}, scene.last, scene.snapshot, scene.association);
  ExpectPose(pose, PoseOnPath(2));
  EXPECT_EQ(pose->inlier_points, scene.association.matches.Points());
}

// Most depths are hardly known. The few others fix the pose, but are too few to rely on.
TEST(PoseSearch, FewKnownDepthsBringInUncertainOnes) {
  constexpr std::size_t kKnown = 12;  // every twelfth
  Scene scene;
  Features features = scene.last.frame.features();
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    Disparity* const disparity = features.point_disparity.Find(i);
    if (disparity != nullptr && i % kKnown != 0) disparity->sigma_px = 0.1 * disparity->px;
  }
  features.line_right.clear();
  features.line_right.resize(features.lines.size());
  scene.last.frame.indexed = IndexFeatures(scene.world.camera, features);
  scene.options.enough_pose_sigma = 0.02;
  const Frame frame = FrameAt(scene.world, 2);
  const auto search = [&] {
    return scene.Search().FromPrediction(
        frame, {PoseOnPath(1)}, scene.last, scene.snapshot, scene.association);
  };
  const auto uncertain = [&] {
    return std::count_if(scene.association.points.begin(),
                         scene.association.points.end(),
                         [](const PointCandidate& p) { return !p.covariance.isZero(0); });
  };
  const auto many = search();
  ASSERT_TRUE(many);
  EXPECT_GT(many->inlier_points, scene.options.enough_inliers);
  EXPECT_GT(uncertain(), scene.options.enough_inliers);
  EXPECT_LT(CentreDistance(many->cam_from_world, PoseOnPath(2)), 0.03);
  scene.options.point_covariance = false;
  ASSERT_TRUE(search());
  EXPECT_EQ(uncertain(), 0);
  scene.options.enough_inliers = 0;
  const auto few = search();
  ASSERT_TRUE(few);
  EXPECT_LT(few->inlier_points, TrackingOptions{}.enough_inliers);
}

TEST(PoseSearch, FindsNoPoseWhereNothingIsToBeSeen) {
  Scene scene;
  Frame frame;
  frame.indexed = IndexFeatures(scene.world.camera, {});
  const auto pose = scene.Search().FromPrediction(
      frame, {PoseOnPath(0)}, scene.last, scene.snapshot, scene.association);
  EXPECT_FALSE(pose);
}

// Of the newest keyframe, or with odometry of the last frame.
TEST(PoseSearch, FindsByAppearanceWhatNoPredictionLeadsTo) {
  constexpr int kFarAway = 15;
  for (const auto reference : {TrackingReference::kLocalMap, TrackingReference::kLastFrame}) {
    Scene scene;
    scene.options.reference = reference;
    const Frame frame = FrameAt(scene.world, kFarAway);
    FrameCounts counts;
    const auto pose =
        scene.Search().FromAppearance(frame, scene.last, scene.snapshot, scene.association, counts);
    ExpectPose(pose, PoseOnPath(kFarAway));
    EXPECT_GT(counts.matched_points, 50);
  }
}

TEST(PoseSearch, FindsByAppearanceThoughMostMatchesAreWrong) {
  constexpr int kFarAway = 15;
  Scene scene;
  const Frame seen = FrameAt(scene.world, kFarAway);
  Features features = seen.features();
  Rng rng(4, "wrong_matches");
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    if (i % 5 < 3) features.points[i].px = {rng.Uniform(0, 751), rng.Uniform(0, 479)};
  }
  Frame frame = seen;
  frame.indexed = IndexFeatures(scene.world.camera, features);
  FrameCounts counts;
  const auto pose =
      scene.Search().FromAppearance(frame, scene.last, scene.snapshot, scene.association, counts);
  ASSERT_TRUE(pose);
  EXPECT_LT(CentreDistance(pose->cam_from_world, PoseOnPath(kFarAway)), 0.03);
  EXPECT_LT(2 * pose->inlier_points, counts.matched_points);
}

// With 13 matches, three of them fix the pose, and of the other 10 one agrees by chance on average,
// with a standard deviation of 0.95: 3 + 1 + 3 * 0.95 = 6.85 have to agree. With 33, 103 and 1003
// matches the same sum is 10.9, 22 and 131.5.
TEST(MoreThanChance, IsThreeStandardDeviationsMoreBesideThreeMatches) {
  EXPECT_FALSE(MoreThanChance(6, 13));
  EXPECT_TRUE(MoreThanChance(7, 13));
  EXPECT_FALSE(MoreThanChance(10, 33));
  EXPECT_TRUE(MoreThanChance(11, 33));
  EXPECT_FALSE(MoreThanChance(21, 103));
  EXPECT_TRUE(MoreThanChance(22, 103));
  EXPECT_FALSE(MoreThanChance(131, 1003));
  EXPECT_TRUE(MoreThanChance(132, 1003));
}

TEST(MoreThanChance, IsAllOfVeryFew) {
  for (const int few : {1, 2, 3, 4, 5}) {
    EXPECT_TRUE(MoreThanChance(few, few)) << few;
    EXPECT_FALSE(MoreThanChance(few - 1, few)) << few;
  }
  EXPECT_TRUE(MoreThanChance(5, 6));
  EXPECT_TRUE(MoreThanChance(0, 0)) << "nothing disagrees";
}

TEST(PoseSearch, LinesThatDisagreeDoNotCountAgainstAPose) {
  PoseEstimate pose;
  pose.inlier_points = 11;
  EXPECT_TRUE(PoseSearch::Agreed(pose, {.matched_points = 33, .matched_lines = 500}));
  EXPECT_FALSE(PoseSearch::Agreed(pose, {.matched_points = 40, .matched_lines = 0}));
  pose.inlier_lines = 40;  // which count for it
  EXPECT_TRUE(PoseSearch::Agreed(pose, {.matched_points = 200, .matched_lines = 100}));
  pose.inlier_points = 0;
  EXPECT_TRUE(PoseSearch::Agreed(pose, {.matched_points = 0, .matched_lines = 100}));
}

TEST(PoseSearch, FindsMoreOfTheLastFrameFromAFirstPose) {
  Scene scene;
  const Frame frame = FrameAt(scene.world, 2);
  const PoseSearch search = scene.Search();
  const auto first =
      search.FromPrediction(frame, {PoseOnPath(1)}, scene.last, scene.snapshot, scene.association);
  ASSERT_TRUE(first);
  const PoseAttempt attempt = search.WithLastFrame(frame, *first, {}, scene.association);
  ExpectPose(attempt.pose, PoseOnPath(2));
  EXPECT_GE(attempt.counts.matched_points, first->inlier_points);
}

}  // namespace pose_search_test

}  // namespace plumbline
