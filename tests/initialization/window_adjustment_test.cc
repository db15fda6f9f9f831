// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_adjustment.h"

#include "tests/initialization/window_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeWindowScene;
using testing::RotationErrorDeg;
using testing::WindowScene;

constexpr double kMaxChi2 = 9.21;

TEST(Evaluate, CountsWhatFits) {
  const WindowScene exact = MakeWindowScene(1, CurvedMotion(3), {.points = 100});
  const WindowFit fit = EvaluateWindow(exact.tracks, exact.truth, kMaxChi2);
  EXPECT_EQ(fit.measurements, 400);
  EXPECT_EQ(fit.inliers, 400);
  EXPECT_LT(fit.cost, 1e-12);
  WindowSolution unknown = exact.truth;
  unknown.is_known[7] = false;
  const WindowFit without = EvaluateWindow(exact.tracks, unknown, kMaxChi2);
  EXPECT_NEAR(without.cost, 4 * kMaxChi2, 1e-9) << "a point without place costs in full";
  EXPECT_EQ(without.inliers, 396);
}

TEST(AdjustWindow, EndsAtTheLeastSquaresAndMeasuresTheNoise) {
  WindowScene scene = MakeWindowScene(2, CurvedMotion(3), {.points = 300, .sigma = 1e-3});
  for (TrackedPoints* view : {&scene.tracks.reference,
                              &scene.tracks.views[0],
                              &scene.tracks.views[1],
                              &scene.tracks.views[2]}) {
    for (double& sigma : view->sigmas) sigma *= 2;  // half the noise that is said
  }
  const WindowSolution adjusted = AdjustWindow(scene.tracks, scene.truth, 20);
  const WindowFit fit = EvaluateWindow(scene.tracks, adjusted, kMaxChi2);
  EXPECT_LT(fit.cost, EvaluateWindow(scene.tracks, scene.truth, kMaxChi2).cost);
  EXPECT_NEAR(fit.noise, 0.5, 0.05);
}

TEST(AdjustWindow, LeavesWrongMatchesOut) {
  const WindowScene scene =
      MakeWindowScene(3, CurvedMotion(3), {.points = 300, .sigma = 1e-3, .outliers = 0.15});
  WindowSolution start = scene.truth;
  for (Rigid3& pose : start.cam_from_reference) {
    pose = RetractLeft(pose, (Vector6d() << 0.002, -0.002, 0.001, 0.004, 0.004, 0).finished());
  }
  const WindowSolution adjusted = AdjustWindow(scene.tracks, start, 10);
  const Rigid3& newest = scene.truth.cam_from_reference.back();
  EXPECT_LT(RotationErrorDeg(adjusted.cam_from_reference.back(), newest), 0.1);
  EXPECT_LT(DirectionErrorDeg(adjusted.cam_from_reference.back(), newest), 1);
}

TEST(ScaleToMedianDepth, MakesItOne) {
  WindowScene scene = MakeWindowScene(4, CurvedMotion(2), {.points = 101});
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

}  // namespace
}  // namespace plumbline
