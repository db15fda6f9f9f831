// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/stereo_calibration.h"

#include "tests/support/true_map.h"
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const RectifiedCamera kCamera{400, 400, 320, 240, 0.1, 640, 480};
constexpr auto kSlice = static_cast<std::int64_t>(StereoChange::kSlice);

StereoCorrection By(double px) { return {kCamera, px * Vector6d::Unit(0)}; }

// A keyframe with one point, of this disparity.
void AddKeyFrame(Map& map, double disparity) {
  Features features;
  features.points.resize(1);
  features.point_disparity = {Disparity{disparity, 1}};
  KeyFrame keyframe;
  keyframe.id = map.NextKeyFrameId();
  keyframe.frame.indexed = IndexFeatures(kCamera, std::move(features));
  keyframe.frame.points.resize(1);
  map.Apply({edit::AddKeyFrame{keyframe}});
}

Map MapOf(std::int64_t keyframes) {
  Map map;
  for (std::int64_t i = 0; i < keyframes; ++i) AddKeyFrame(map, 10 + static_cast<double>(i));
  return map;
}

// By how much each keyframe of the map is corrected; they agree.
double CorrectionOf(const Map& map) {
  const auto of = [&](const KeyFrame& keyframe) {
    return 10 + static_cast<double>(keyframe.id.value) -
           keyframe.frame.features().point_disparity[0]->px;
  };
  const double first = of(map.keyframes().begin()->second);
  for (const auto& [id, keyframe] : map.keyframes()) {
    EXPECT_NEAR(of(keyframe), first, 1e-9) << id.value;
    EXPECT_EQ(keyframe.frame.indexed->correction, map.correction()) << id.value;
  }
  return first;
}

TEST(StereoChange, IsMadeAtOnceInASmallMap) {
  Map map = MapOf(kSlice);
  StereoChange change;
  change.Begin(map, By(0.5));
  EXPECT_TRUE(change.Running(map));
  change.Step(map);
  EXPECT_FALSE(change.Running(map));
  EXPECT_DOUBLE_EQ(CorrectionOf(map), 0.5);
}

// The map is never in between, and keyframes that come meanwhile have the same correction.
TEST(StereoChange, TakesEffectWhenAllKeyFramesAreReady) {
  Map map = MapOf(2 * kSlice + 10);
  StereoChange change;
  change.Begin(map, By(0.5));
  for (int step = 0; step < 2; ++step) {
    change.Step(map);
    EXPECT_EQ(CorrectionOf(map), 0);
    AddKeyFrame(map, 10 + static_cast<double>(map.NextKeyFrameId().value));
  }
  const auto before = map.keyframes().begin()->second.frame.indexed;
  change.Step(map);
  EXPECT_FALSE(change.Running(map));
  EXPECT_DOUBLE_EQ(CorrectionOf(map), 0.5);
  // What nobody needs is let go a part at a time, too.
  EXPECT_GT(before.use_count(), 1);
  for (int step = 0; step < 3; ++step) change.Step(map);
  EXPECT_EQ(before.use_count(), 1);
}

// The map that took it in has a correction of its own.
TEST(StereoChange, IsGivenUpWhereTheMapIsJoinedToAnotherOne) {
  Atlas atlas;
  for (int i = 0; i < 2; ++i) atlas.Start();
  const Map changing(MapId{1});
  StereoChange change;
  change.Begin(changing, By(0.5));
  change.FollowJoins(atlas);
  EXPECT_TRUE(change.Running(changing));
  atlas.Join(MapId{0}, MapId{1}, {});
  change.FollowJoins(atlas);
  EXPECT_FALSE(change.Running(changing));
}

TEST(StereoChange, IsOfOneMapAndMayBeGivenUp) {
  Map map = MapOf(kSlice + 10), other(MapId{1});
  AddKeyFrame(other, 10);
  StereoChange change;
  change.Begin(map, By(0.5));
  EXPECT_FALSE(change.Running(other));
  change.Step(other);
  EXPECT_EQ(CorrectionOf(other), 0);
  change.GiveUp();
  change.Step(map);
  change.Step(map);
  EXPECT_EQ(CorrectionOf(map), 0);
}

}  // namespace

namespace stereo_calibration_test {

// A displacement whose mean over the image is small.
StereoCorrection Displacement(const RectifiedCamera& camera) {
  Vector6d k;
  k << 0.2, 0.4, -0.3, -0.8, 0.3, 0.2;
  return {camera, k};
}

// A map whose right images are displaced.
TrueMap Scene(const SyntheticWorld& world, const SensorModel& sensor) {
  std::vector<Rigid3> poses;
  for (int k = 0; k < 12; ++k) poses.push_back(PoseOnPath(8 * k));
  TrueMap scene = MakeTrueMap(world, poses, sensor);
  Map displaced;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    KeyFrame copy = keyframe;
    auto indexed = std::make_shared<FrameFeatures>(*keyframe.frame.indexed);
    Correct({Displacement(world.camera)}, {}, indexed->features);
    copy.frame.indexed = indexed;
    copy.frame.points.assign(copy.frame.points.size(), PointId{});
    copy.frame.lines.assign(copy.frame.lines.size(), LineId{});
    displaced.Apply({edit::AddKeyFrame{copy}});
  }
  MapEdit landmarks;
  for (const auto& [id, point] : scene.map.points()) landmarks.push_back(edit::AddPoint{point});
  for (const auto& [id, line] : scene.map.lines()) landmarks.push_back(edit::AddLine{line});
  displaced.Apply(landmarks);
  scene.map = displaced;
  return scene;
}

// RMS of the difference but for its mean, over the landmarks' places in the right images.
double ErrorBesideTheMean(const StereoCorrection& estimate,
                          const SyntheticWorld& world,
                          const Map& map) {
  double sum = 0, squares = 0, count = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    for (const PointFeature& point : keyframe.frame.features().points) {
      const double error = estimate.At(point.px) - Displacement(world.camera).At(point.px);
      sum += error;
      squares += error * error;
      ++count;
    }
    for (const auto& right : keyframe.frame.features().line_right) {
      if (!right) continue;
      const Eigen::Vector2d px = right->segment.Midpoint();
      const double error = estimate.At(px) - Displacement(world.camera).At(px);
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

StereoCorrection Learn(const SyntheticWorld& world, const Map& map) {
  StereoCalibrator calibrator(world.camera);
  for (const auto& [id, keyframe] : map.keyframes()) calibrator.Observe(map, keyframe);
  return calibrator.Estimate();
}

TEST(StereoCalibrator, LearnsTheDisplacementFromPoints) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 0);
  const TrueMap scene = Scene(world, {.noise = 0.5});
  const double before = ErrorBesideTheMean({}, world, scene.map);
  EXPECT_GT(before, 0.2);
  EXPECT_LT(ErrorBesideTheMean(Learn(world, scene.map), world, scene.map), 0.25 * before);
}

TEST(StereoCalibrator, LearnsNothingFromLines) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 100);
  const TrueMap scene = Scene(world, {.noise = 0.5});
  EXPECT_EQ(Learn(world, scene.map), StereoCorrection());
}

TEST(StereoCalibrator, LearnsTheSameFromDisparitiesThatAreCorrectedAlready) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 100);
  TrueMap scene = Scene(world, {.noise = 0.5});
  const StereoCorrection first = Learn(world, scene.map);
  scene.map.Apply({edit::CorrectFeatures{{first}}});
  const StereoCorrection second = Learn(world, scene.map);
  for (const double x : {50.0, 300.0, 600.0}) {
    EXPECT_NEAR(first.At({x, 200}), second.At({x, 200}), 0.01);
  }
}

TEST(StereoCalibrator, LeavesTheMeanAlone) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 0);
  const TrueMap scene = Scene(world, {.noise = 0.1});
  const StereoCorrection estimate = Learn(world, scene.map);
  double sum = 0, count = 0;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    const Features& features = keyframe.frame.features();
    for (std::size_t i = 0; i < features.points.size(); ++i) {
      if (!features.point_disparity[i]) continue;
      sum +=
          estimate.At(features.points[i].px - Eigen::Vector2d(features.point_disparity[i]->px, 0));
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 0, 0.05);
}

TEST(StereoCalibrator, FindsNothingWhereNothingIs) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 100);
  std::vector<Rigid3> poses;
  for (int k = 0; k < 12; ++k) poses.push_back(PoseOnPath(8 * k));
  const TrueMap scene = MakeTrueMap(world, poses, {.noise = 0.5});
  const StereoCorrection estimate = Learn(world, scene.map);
  EXPECT_EQ(estimate, StereoCorrection());
}

// A map that is too large says nothing about the images, though its disparities seem wrong most
// where things are near.
TEST(StereoCalibrator, LeavesTheScaleOfTheMapAlone) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 0);
  std::vector<Rigid3> poses;
  for (int k = 0; k < 12; ++k) poses.push_back(PoseOnPath(8 * k));
  const TrueMap scene = MakeTrueMap(world, poses, {.noise = 0.1});
  Map scaled;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    KeyFrame copy = keyframe;
    copy.frame.cam_from_world.translation *= 1.05;
    copy.frame.points.assign(copy.frame.points.size(), PointId{});
    copy.frame.lines.assign(copy.frame.lines.size(), LineId{});
    scaled.Apply({edit::AddKeyFrame{copy}});
  }
  MapEdit landmarks;
  for (const auto& [id, point] : scene.map.points()) {
    MapPoint copy = point;
    copy.position *= 1.05;
    landmarks.push_back(edit::AddPoint{copy});
  }
  scaled.Apply(landmarks);
  EXPECT_EQ(Learn(world, scaled), StereoCorrection());
}

// Evidence at places all over the right image that found these coefficients with this deviation.
StereoEvidence EvidenceOf(const RectifiedCamera& camera,
                          const Vector6d& coefficients,
                          double sigma) {
  StereoEvidence evidence;
  for (int x = 20; x < camera.width; x += 40) {
    for (int y = 20; y < camera.height; y += 40) {
      const Vector6d terms = StereoCorrection::Terms(camera, Eigen::Vector2d(x, y));
      evidence.moments += terms * terms.transpose() / (sigma * sigma);
    }
  }
  evidence.information = evidence.moments;
  evidence.weighted = evidence.information * coefficients;
  return evidence;
}

// What is learned from such evidence of a correction linear in x and y.
StereoCorrection LearnedFrom(double of_x, double of_y, double sigma) {
  const Vector6d coefficients = (Vector6d() << 0, of_x, of_y, 0, 0, 0).finished();
  StereoCalibrator calibrator(TestCamera());
  calibrator.SetEvidence(EvidenceOf(TestCamera(), coefficients, sigma));
  return calibrator.Estimate();
}

TEST(StereoCalibrator, BelievesWhatItsEvidenceIsSureOf) {
  EXPECT_NEAR(LearnedFrom(0.5, 0, 0.1).coefficients()(1), 0.5, 0.05);
  EXPECT_EQ(LearnedFrom(0.5, 0, 20), StereoCorrection());
}

TEST(StereoCalibrator, LeavesOutPartsThatMayBeNoise) {
  const Vector6d found = LearnedFrom(0.5, 0.02, 1).coefficients();
  EXPECT_GT(found(1), 0.35);
  EXPECT_LT(std::abs(found(2)), 0.01);
}

TEST(StereoCalibrator, HasNoOpinionWithoutEvidence) {
  EXPECT_EQ(StereoCalibrator(TestCamera()).Estimate(), StereoCorrection());
  const SyntheticWorld world = MakeSyntheticWorld(100, 50);
  std::vector<Rigid3> poses;
  for (int k = 0; k < 6; ++k) poses.push_back(PoseOnPath(8 * k));
  const TrueMap scene = MakeTrueMap(world, poses, {.depth = false});
  EXPECT_EQ(Learn(world, scene.map), StereoCorrection());
}

}  // namespace stereo_calibration_test

}  // namespace plumbline
