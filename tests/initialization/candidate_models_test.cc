// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/candidate_models.h"

#include "tests/initialization/track_scene.h"
#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace candidate_models_test {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeTrackScene;
using testing::RotationErrorDeg;
using testing::TrackScene;
using testing::TrackSceneOptions;

constexpr double kSigma = 5e-4;
constexpr int kSeeds = 20;

CandidateModel At(const Rigid3& newest, double cost) {
  CandidateModel model;
  model.reconstruction.cam_from_reference = {newest};
  model.cost = cost;
  return model;
}

TEST(InsertModel, KeepsTheCheaperOfTwoThatAreTheSame) {
  const Rigid3 pose = CurvedMotion(1).front();
  const Rigid3 larger{pose.rotation, 3 * pose.translation};
  const Rigid3 turned{ExpSo3({0, 0.006, 0}) * pose.rotation, pose.translation};
  std::vector<CandidateModel> models;
  InsertModel(At(pose, 5), models);
  InsertModel(At(larger, 4), models);  // the unit is free
  InsertModel(At(pose, 6), models);
  InsertModel(At(turned, 2), models);
  SortByCost(models);
  ASSERT_EQ(models.size(), 2U);
  EXPECT_EQ(models[0].cost, 2);
  EXPECT_EQ(models[1].cost, 4);
  EXPECT_EQ(models[1].reconstruction.cam_from_reference[0].translation, larger.translation);
}

TEST(AdjustModel, EndsAtTheTruth) {
  const TrackScene scene = MakeTrackScene(1, CurvedMotion(3), {.points = 60});
  CandidateModel model;
  model.reconstruction = scene.truth;
  Eigen::Quaterniond& turned = model.reconstruction.cam_from_reference.back().rotation;
  turned = ExpSo3({0.003, 0, 0.002}) * turned;
  AdjustModel(scene.tracks, model);
  EXPECT_LT(RotationErrorDeg(model.reconstruction.cam_from_reference.back(),
                             scene.truth.cam_from_reference.back()),
            1e-2);
  EXPECT_LT(model.cost, 1e-3);
  EXPECT_EQ(model.cost, model.fit.cost);
}

CandidateModel ByPoints(const TrackScene& scene) {
  CandidateModel model;
  model.reconstruction = scene.truth;
  model.reconstruction.lines.clear();
  AdjustModel(scene.tracks, model);
  return model;
}

TEST(AdjustWithLines, MakesFewPointsAccurate) {
  double points = 0;
  double lines = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    TrackScene scene = MakeTrackScene(
        seed, CurvedMotion(3), {.points = 14, .sigma = kSigma, .lines = 40, .line_noise = 0.25});
    const CandidateModel by_points = ByPoints(scene);
    const auto adjusted = AdjustWithLines(scene.tracks, {by_points}, 0.25);
    const Rigid3& truth = scene.truth.cam_from_reference.back();
    const auto squared = [&](const Reconstruction& reconstruction) {
      return std::pow(RotationErrorDeg(reconstruction.cam_from_reference.back(), truth), 2);
    };
    points += squared(by_points.reconstruction);
    lines += squared(adjusted.front().reconstruction);
  }
  EXPECT_LT(std::sqrt(lines), 0.7 * std::sqrt(points));
}

// They fit no model, and so count for none.
TEST(AdjustWithLines, LeavesWrongMatchesOut) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    TrackScene scene = MakeTrackScene(
        seed, CurvedMotion(3), {.points = 30, .sigma = kSigma, .lines = 30, .wrong_lines = 6});
    const auto adjusted = AdjustWithLines(scene.tracks, {ByPoints(scene)}, 0.25);
    const CandidateModel& best = adjusted.front();
    EXPECT_LE(best.lines, 25);  // one by chance
    EXPECT_GE(best.lines, 20);
    const Rigid3& truth = scene.truth.cam_from_reference.back();
    EXPECT_LT(RotationErrorDeg(best.reconstruction.cam_from_reference.back(), truth), 0.35) << seed;
    EXPECT_LT(DirectionErrorDeg(best.reconstruction.cam_from_reference.back(), truth), 2) << seed;
    // Of the 24, up to some in an epipolar plane: what four degrees of freedom each leave over.
    EXPECT_LT(best.cost - best.fit.cost, 24 * 8);
  }
}

// Of what the lines are said to have: half.
TEST(AdjustWithLines, FindsTheNoiseOfTheLines) {
  TrackScene scene =
      MakeTrackScene(5, CurvedMotion(3), {.points = 60, .sigma = kSigma, .lines = 200});
  for (ViewLines* view : {&scene.tracks.lines.reference,
                          &scene.tracks.lines.views[0],
                          &scene.tracks.lines.views[1],
                          &scene.tracks.lines.views[2]}) {
    for (double& sigma : view->sigmas) sigma *= 2;
  }
  const auto adjusted = AdjustWithLines(scene.tracks, {ByPoints(scene)}, 0.05);
  EXPECT_NEAR(
      adjusted.front().line_noise * scene.tracks.lines.reference.sigmas[0] / kSigma, 1, 0.15);
}

// On a plane, by a camera that hardly turns, the valley has a second minimum.
TEST(AdjustWithLines, FindsAnotherMinimumOfTheValley) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    TrackScene scene = MakeTrackScene(
        seed, CurvedMotion(3, 0.15), {.points = 14, .plane = true, .sigma = kSigma, .lines = 15});
    const auto adjusted = AdjustWithLines(scene.tracks, {ByPoints(scene)}, 0.25);
    for (std::size_t j = 1; j < adjusted.size(); ++j) {
      EXPECT_LE(adjusted[j - 1].cost, adjusted[j].cost);
      EXPECT_FALSE(IsSameMotion(adjusted[0].reconstruction.cam_from_reference.back(),
                                adjusted[j].reconstruction.cam_from_reference.back()));
    }
    found += adjusted.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(found, 0);
}

}  // namespace candidate_models_test
}  // namespace plumbline
