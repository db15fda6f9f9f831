// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/model_selection.h"

#include "tests/initialization/track_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace model_selection_test {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeTrackScene;
using testing::RotationErrorDeg;
using testing::TrackScene;
using testing::TrackSceneOptions;

constexpr double kSigma = 0.25 / 520;  // of the corners of recorded images, in the median
constexpr int kSeeds = 20;

// Twice, since the first time there is nothing to confirm it.
ModelSelection Decide(const TrackScene& scene, std::uint64_t seed) {
  PriorHypotheses prior;
  Rng rng(seed, "decide");
  EXPECT_FALSE(SelectModel(scene.tracks, {}, prior, rng).reconstruction);
  return SelectModel(scene.tracks, {}, prior, rng);
}

bool IsRight(const TrackScene& scene, const Reconstruction& solution) {
  const Rigid3& truth = scene.truth.cam_from_reference.back();
  const Rigid3& found = solution.cam_from_reference.back();
  return RotationErrorDeg(found, truth) < 0.5 && DirectionErrorDeg(found, truth) < 5;
}

struct Count {
  int right = 0, wrong = 0;
};

// The turns of the scene's true motion as a gyroscope tells them, turned on by `wrong`.
MeasuredTurns TurnsOf(const TrackScene& scene, const Eigen::Vector3d& wrong) {
  MeasuredTurns turns;
  turns.errors = 1e-4 * Matrix7d::Identity();
  for (const Rigid3& pose : scene.truth.cam_from_reference) {
    CameraTurn turn;
    turn.b_from_a = ExpSo3(wrong) * pose.rotation;
    turn.noise = turn.covariance = 1e-6 * Eigen::Matrix3d::Identity();
    turns.of_views.push_back(turn);
  }
  return turns;
}

Count CountOf(const std::vector<Rigid3>& poses, const TrackSceneOptions& options) {
  Count count;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const TrackScene scene = MakeTrackScene(seed, poses, options);
    const ModelSelection selection = Decide(scene, seed);
    EXPECT_EQ(selection.reconstruction.has_value(), selection.wait == InitializationStatus::kNone);
    if (!selection.reconstruction) continue;
    ++(IsRight(scene, *selection.reconstruction) ? count.right : count.wrong);
  }
  return count;
}

// Starts before a plane, with a gyroscope whose turns are turned on by `wrong`.
Count CountOfPlaneBy(const std::vector<Rigid3>& poses, const Eigen::Vector3d& wrong) {
  Count count;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const TrackScene scene = MakeTrackScene(seed, poses, {.plane = true, .sigma = kSigma});
    const MeasuredTurns turns = TurnsOf(scene, wrong);
    PriorHypotheses prior;
    Rng rng(seed, "decide");
    SelectModel(scene.tracks, {}, prior, rng, turns);
    const auto found = SelectModel(scene.tracks, {}, prior, rng, turns).reconstruction;
    if (found) ++(IsRight(scene, *found) ? count.right : count.wrong);
  }
  return count;
}

TEST(SelectModel, FindsACloudOfPoints) {
  const Count count =
      CountOf(CurvedMotion(3, 1), {.sigma = kSigma, .missed = 0.2, .outliers = 0.06});
  EXPECT_GE(count.right, kSeeds - 1);
  EXPECT_EQ(count.wrong, 0);
}

// The twofold ambiguity of a plane is decided by motion that changes its direction.
TEST(SelectModel, TellsTheTwoInterpretationsOfAPlaneApart) {
  const Count count = CountOf(CurvedMotion(4, 1.4), {.plane = true, .sigma = kSigma});
  EXPECT_GE(count.right, kSeeds - 3);
  EXPECT_EQ(count.wrong, 0);
}

// Straight on, without turning, all frames share both interpretations: nothing to decide by.
TEST(SelectModel, WaitsWhereAPlaneIsAmbiguous) {
  std::vector<Rigid3> poses;
  for (int i = 1; i <= 3; ++i) {
    poses.push_back({Eigen::Quaterniond::Identity(), -0.15 * i * Eigen::Vector3d(1, 0.2, 0.2)});
  }
  const Count count = CountOf(poses, {.plane = true, .sigma = kSigma});
  EXPECT_EQ(count.wrong, 0);
}

// Only one of them turns as the camera did. A gyroscope that contradicts both, as a wrong
// calibration makes it, decides nothing.
TEST(SelectModel, AGyroscopeMakesNoStartWrongAndPreventsNone) {
  std::vector<Rigid3> poses;
  for (int i = 1; i <= 3; ++i) {
    poses.push_back({Eigen::Quaterniond::Identity(), -0.15 * i * Eigen::Vector3d(1, 0.2, 0.2)});
  }
  const Count by_images = CountOf(poses, {.plane = true, .sigma = kSigma});
  const Count by_gyroscope = CountOfPlaneBy(poses, {0, 0, 0});
  EXPECT_GE(by_gyroscope.right, by_images.right);
  EXPECT_EQ(by_gyroscope.wrong, 0);
  const Count contradicted = CountOfPlaneBy(poses, {0, 0, 1});
  EXPECT_EQ(contradicted.right, by_images.right);
  EXPECT_EQ(contradicted.wrong, 0);
}

// Where a camera turns a little, images leave some of these starts open.
TEST(SelectModel, AGyroscopeDecidesStartsThatImagesLeaveOpen) {
  Count by_images, by_gyroscope;
  for (const double step : {0.1, 0.15}) {
    std::vector<Rigid3> poses;
    for (int i = 1; i <= 3; ++i) {
      poses.push_back({ExpSo3({0.02 * i, 0.05 * i, 0}), -step * i * Eigen::Vector3d(1, 0.2, 0.2)});
    }
    const Count images = CountOf(poses, {.plane = true, .sigma = kSigma});
    const Count gyroscope = CountOfPlaneBy(poses, {0, 0, 0});
    by_images.right += images.right;
    by_gyroscope.right += gyroscope.right;
    by_gyroscope.wrong += gyroscope.wrong;
  }
  EXPECT_GT(by_gyroscope.right, by_images.right);
  EXPECT_EQ(by_gyroscope.wrong, 0);
}

TEST(TurnChi2, TellsHowFarRotationsAreFromTheGyroscopes) {
  const TrackScene scene = MakeTrackScene(1, CurvedMotion(3, 1), {.sigma = kSigma});
  EXPECT_LT(TurnChi2(TurnsOf(scene, {0, 0, 0}), scene.truth), 1e-9);
  EXPECT_GT(TurnChi2(TurnsOf(scene, {0, 0.05, 0}), scene.truth), 100);
  // Where the bias may be the cause, it says nothing.
  MeasuredTurns open = TurnsOf(scene, {0, 0.05, 0});
  for (CameraTurn& turn : open.of_views) turn.by_errors.leftCols<3>().setIdentity();
  open.errors.topLeftCorner<3, 3>().diagonal().setConstant(0.05 * 0.05);
  EXPECT_LT(TurnChi2(open, scene.truth), 2);
}

TEST(SelectModel, WaitsWhileTheCameraTurnsOrStands) {
  std::vector<Rigid3> turning;
  for (int i = 1; i <= 3; ++i) turning.push_back({ExpSo3({0, 0.05 * i, 0.01 * i}), {0, 0, 0}});
  const std::vector<Rigid3> standing(3);
  for (const auto& poses : {turning, standing}) {
    const Count count = CountOf(poses, {.sigma = kSigma, .outliers = 0.05});
    EXPECT_EQ(count.right + count.wrong, 0);
  }
}

// The turns that a gyroscope tells are no reason to believe in a motion.
TEST(SelectModel, WaitsWhileTheCameraOnlyTurnsByItsGyroscope) {
  std::vector<Rigid3> turning;
  for (int i = 1; i <= 3; ++i) turning.push_back({ExpSo3({0, 0.05 * i, 0.01 * i}), {0, 0, 0}});
  for (const bool plane : {false, true}) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const TrackScene scene =
          MakeTrackScene(seed, turning, {.plane = plane, .sigma = kSigma, .outliers = 0.05});
      const MeasuredTurns turns = TurnsOf(scene, {0, 0, 0});
      PriorHypotheses prior;
      Rng rng(seed, "decide");
      SelectModel(scene.tracks, {}, prior, rng, turns);
      const ModelSelection selection = SelectModel(scene.tracks, {}, prior, rng, turns);
      EXPECT_FALSE(selection.reconstruction) << seed;
      EXPECT_NE(selection.wait, InitializationStatus::kNone);
    }
  }
}

// A third of the points move together before a camera that stands: they alone show parallax.
TEST(SelectModel, WaitsWhenAThingMovesBeforeACameraAtRest) {
  const std::vector<Rigid3> thing = CurvedMotion(3);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    TrackScene scene = MakeTrackScene(seed, std::vector<Rigid3>(3), {.sigma = kSigma});
    for (std::size_t k = 0; k < scene.tracks.size(); k += 3) {
      for (std::size_t i = 0; i < thing.size(); ++i) {
        scene.tracks.views[i].points[k] = (thing[i] * scene.truth.points[k]).hnormalized();
      }
    }
    EXPECT_FALSE(Decide(scene, seed).reconstruction) << seed;
  }
}

TEST(SelectModel, NeedsMatches) {
  const TrackScene scene = MakeTrackScene(1, CurvedMotion(3), {.points = 20});
  EXPECT_EQ(Decide(scene, 1).wait, InitializationStatus::kTooFewMatches);
}

// A wall with a dozen corners and the edges of what hangs there.
TEST(SelectModel, StartsFromFewPointsAndLines) {
  const TrackSceneOptions few{.points = 16, .sigma = kSigma};
  TrackSceneOptions lines = few;
  lines.lines = 40;
  lines.line_noise = 0.2;  // of lines in rendered images against corners there
  lines.wrong_lines = 4;
  const Count without = CountOf(CurvedMotion(3, 1), few);
  EXPECT_EQ(without.right + without.wrong, 0);
  const Count with = CountOf(CurvedMotion(3, 1), lines);
  EXPECT_GE(with.right, kSeeds / 2);
  EXPECT_EQ(with.wrong, 0);
}

TEST(SelectModel, WaitsWithLinesWhileTheCameraTurnsOrStands) {
  std::vector<Rigid3> turning;
  for (int i = 1; i <= 3; ++i) turning.push_back({ExpSo3({0, 0.05 * i, 0.01 * i}), {0, 0, 0}});
  const std::vector<Rigid3> standing(3);
  for (const auto& poses : {turning, standing}) {
    const Count count = CountOf(poses, {.points = 30, .sigma = kSigma, .lines = 40});
    EXPECT_EQ(count.right + count.wrong, 0);
  }
}

TEST(SelectModel, ScalesTheMedianDepthToOneAndTellsTheParallax) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 301});
  const ModelSelection selection = Decide(scene, 2);
  ASSERT_TRUE(selection.reconstruction);
  int below = 0;
  for (const Eigen::Vector3d& point : selection.reconstruction->points)
    below += point.z() < 1 ? 1 : 0;
  EXPECT_EQ(below, 150);
  EXPECT_GT(selection.parallax_deg, 3);
  EXPECT_LT(selection.parallax_deg, 10);
}

TEST(PriorHypotheses, BringsPointsBackByFeature) {
  const TrackScene scene = MakeTrackScene(3, CurvedMotion(2), {.points = 50});
  PriorHypotheses prior;
  prior.Keep(scene.tracks, std::vector<CandidateModel>{{scene.truth, {}}}, true);
  EXPECT_TRUE(prior.Confirm(scene.tracks, scene.truth));
  Reconstruction other = scene.truth;
  other.cam_from_reference.back().rotation =
      ExpSo3({0.1, 0, 0}) * other.cam_from_reference.back().rotation;
  EXPECT_FALSE(prior.Confirm(scene.tracks, other));
  FeatureTracks later;
  later.features = {7, 1000, 3};
  const auto hypotheses = prior.HypothesesFor(later);
  ASSERT_EQ(hypotheses.size(), 1U);
  EXPECT_EQ(
      hypotheses[0].inverse_distances,
      (std::vector<double>{1 / scene.truth.points[7].norm(), 0, 1 / scene.truth.points[3].norm()}));
  prior.Keep(scene.tracks, std::vector<CandidateModel>{{scene.truth, {}}}, false);
  EXPECT_FALSE(prior.Confirm(scene.tracks, scene.truth)) << "it was not sure";
  prior.Clear();
  EXPECT_TRUE(prior.HypothesesFor(later).empty());
}

}  // namespace model_selection_test
}  // namespace plumbline
