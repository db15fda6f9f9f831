// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/reconstruction.h"

#include "tests/initialization/track_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace reconstruction_test {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeTrackScene;
using testing::RotationErrorDeg;
using testing::TrackScene;

constexpr double kMaxChi2 = 9.21;

TEST(EvaluatePoints, CountsInliers) {
  const TrackScene exact = MakeTrackScene(1, CurvedMotion(3), {.points = 100});
  const ReprojectionFit fit = EvaluatePoints(exact.tracks, exact.truth, kMaxChi2);
  EXPECT_EQ(fit.measurements, 400);
  EXPECT_EQ(fit.inliers, 400);
  EXPECT_LT(fit.cost, 1e-12);
  Reconstruction unknown = exact.truth;
  unknown.is_known[7] = false;
  const ReprojectionFit without = EvaluatePoints(exact.tracks, unknown, kMaxChi2);
  EXPECT_NEAR(without.cost, 4 * kMaxChi2, 1e-9) << "a point without place costs in full";
  EXPECT_EQ(without.inliers, 396);
}

TEST(BundleAdjust, EndsAtTheLeastSquaresAndMeasuresTheNoise) {
  TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 300, .sigma = 1e-3});
  for (ViewPoints* view : {&scene.tracks.reference,
                           &scene.tracks.views[0],
                           &scene.tracks.views[1],
                           &scene.tracks.views[2]}) {
    for (double& sigma : view->sigmas) sigma *= 2;  // half the noise that is said
  }
  const Reconstruction adjusted = BundleAdjust(scene.tracks, scene.truth, 20);
  const ReprojectionFit fit = EvaluatePoints(scene.tracks, adjusted, kMaxChi2);
  EXPECT_LT(fit.cost, EvaluatePoints(scene.tracks, scene.truth, kMaxChi2).cost);
  EXPECT_NEAR(fit.noise, 0.5, 0.05);
}

TEST(BundleAdjust, LeavesWrongMatchesOut) {
  const TrackScene scene =
      MakeTrackScene(3, CurvedMotion(3), {.points = 300, .sigma = 1e-3, .outliers = 0.15});
  Reconstruction start = scene.truth;
  for (Rigid3& pose : start.cam_from_reference) {
    pose = RetractLeft(pose, (Vector6d() << 0.002, -0.002, 0.001, 0.004, 0.004, 0).finished());
  }
  const Reconstruction adjusted = BundleAdjust(scene.tracks, start, 10);
  const Rigid3& newest = scene.truth.cam_from_reference.back();
  EXPECT_LT(RotationErrorDeg(adjusted.cam_from_reference.back(), newest), 0.1);
  EXPECT_LT(DirectionErrorDeg(adjusted.cam_from_reference.back(), newest), 1);
}

TEST(ScaleToMedianDepth, MakesItOne) {
  TrackScene scene = MakeTrackScene(4, CurvedMotion(2), {.points = 101});
  const Rigid3 before = scene.truth.cam_from_reference[1];
  const double ratio = before.translation.norm() / scene.truth.points[3].norm();
  ScaleToMedianDepth(scene.truth);
  int below = 0;
  for (const Eigen::Vector3d& point : scene.truth.points) below += point.z() < 1 ? 1 : 0;
  EXPECT_EQ(below, 50);
  EXPECT_NEAR(scene.truth.cam_from_reference[1].translation.norm() / scene.truth.points[3].norm(),
              ratio,
              1e-12);
}

TEST(TriangulateLines, FindsTheLinesOfTheScene) {
  const TrackScene scene = MakeTrackScene(1, CurvedMotion(3), {.points = 10, .lines = 30});
  Reconstruction found_again = scene.truth;
  TriangulateLines(scene.tracks, found_again);
  const auto& lines = found_again.lines;
  ASSERT_EQ(lines.size(), 30U);
  int found = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (!lines[k]) continue;  // in an epipolar plane
    ++found;
    EXPECT_LT((lines[k]->moment - scene.truth.lines[k]->moment).norm(), 1e-6) << k;
    EXPECT_LT((lines[k]->direction - scene.truth.lines[k]->direction).norm(), 1e-6) << k;
  }
  EXPECT_GE(found, 28);
}

TEST(EvaluateLines, CountsInliers) {
  TrackScene scene =
      MakeTrackScene(2, CurvedMotion(3), {.points = 10, .lines = 10, .wrong_lines = 1});
  scene.tracks.lines.views[0].sigmas[4] = 0;
  scene.truth.lines[7] = std::nullopt;
  const auto fits = EvaluateLines(scene.tracks, scene.truth, kMaxChi2);
  ASSERT_EQ(fits.size(), 10U);
  EXPECT_FALSE(fits[0].inlier);
  EXPECT_NEAR(fits[0].cost, kMaxChi2, 1e-9) << "one view of four is wrong";
  EXPECT_EQ(fits[3].freedom, 4);
  EXPECT_EQ(fits[4].freedom, 2) << "one view less";
  EXPECT_LT(fits[3].cost, 1e-12);
  EXPECT_NEAR(fits[7].cost, 4 * kMaxChi2, 1e-9) << "a line without place costs in full";
  for (const std::size_t k : {1U, 2U, 3U, 4U, 5U, 6U, 8U, 9U}) EXPECT_TRUE(fits[k].inlier) << k;
  EXPECT_FALSE(fits[7].inlier);
}

TEST(EvaluateLines, MeasuresInStandardDeviations) {
  TrackScene scene = MakeTrackScene(3, CurvedMotion(2), {.points = 10, .lines = 1});
  Segment2& seen = scene.tracks.lines.views[1].segments[0];
  const Eigen::Vector2d along = (seen.end - seen.start).normalized();
  seen.end += 2e-3 * Eigen::Vector2d(-along.y(), along.x());  // two deviations
  EXPECT_NEAR(EvaluateLines(scene.tracks, scene.truth, kMaxChi2)[0].chi2, 4, 1e-6);
  EXPECT_NEAR(MeasurementOf(scene.tracks.lines.views[1], 0, 3).covariance(0, 0), 9e-6, 1e-15);
}

TEST(EvaluateLines, IsEmptyWhereLinesDoNotTakePart) {
  TrackScene scene = MakeTrackScene(4, CurvedMotion(2), {.points = 10, .lines = 3});
  scene.truth.lines.clear();
  EXPECT_TRUE(EvaluateLines(scene.tracks, scene.truth, kMaxChi2).empty());
}

}  // namespace reconstruction_test
}  // namespace plumbline
