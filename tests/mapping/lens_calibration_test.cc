// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/lens_calibration.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/random.h"

#include "tests/support/single_camera.h"
#include <cmath>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Where the image shows what the correction takes to px.
Vector2d Displaced(const LensCorrection& correction, Vector2d px) {
  const Vector2d wanted = px;
  for (int i = 0; i < 20; ++i) px += wanted - correction.At(px);
  return px;
}

// A camera that turns by a right angle on a bend, among points on all sides, its images displaced
// by what a lens correction of `border_px` would
// take away. Each point is shown by some views that follow each other.
BaProblem DriveRoundABend(double border_px, std::uint64_t seed = 3, double noise_px = 0.2) {
  constexpr int kViews = 30, kPoints = 1500, kMostShown = 6;
  constexpr double kRadius = 10;
  BaProblem problem;
  problem.camera = OneCamera();
  const LensCorrection lens(problem.camera, border_px);
  for (int k = 0; k < kViews; ++k) {
    const double angle = 0.5 * std::numbers::pi * k / (kViews - 1);
    const Rigid3 world_from_camera{
        ExpSo3(-angle * Vector3d::UnitY()),
        {-kRadius * (1 - math::Cos(angle)), 0, kRadius * math::Sin(angle)}};
    problem.poses.push_back({Inverse(world_from_camera), k < 2});
  }
  Rng rng(seed, "bend");
  for (int i = 0; i < kPoints; ++i) {
    const Vector3d point(rng.Uniform(-35, 15), rng.Uniform(-3, 3), rng.Uniform(0, 40));
    const int index = static_cast<int>(problem.points.size());
    int shown = 0;
    for (int k = 0; k < kViews && shown < kMostShown; ++k) {
      const Vector3d seen = problem.poses[static_cast<std::size_t>(k)].cam_from_world * point;
      if (seen.z() < 3 || seen.z() > 30) continue;
      const Vector2d px = problem.camera.Project(seen);
      if (px.x() < 0 || px.x() > 600 || px.y() < 0 || px.y() > 180) continue;
      const Vector2d noise(rng.Normal(), rng.Normal());
      problem.point_observations.push_back(
          {k, index, {Displaced(lens, px) + noise_px * noise, noise_px, {}}});
      ++shown;
    }
    if (shown > 0) problem.points.push_back(point);
  }
  return problem;
}

TEST(CalibrateRadialDistortion, FindsWhatTheCalibrationHasLeft) {
  constexpr int kSeeds = 4;
  for (const double border : {3.0, -3.0}) {
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const double found =
          CalibrateRadialDistortion(DriveRoundABend(border, seed)).correction.border_px();
      EXPECT_NEAR(found, border, 1) << seed;
      mean += found / kSeeds;
    }
    EXPECT_NEAR(mean, border, 0.4);
  }
}

// What little had taught is corrected by what the whole map says, and taken back where it says the
// opposite.
TEST(CalibrateRadialDistortion, ChangesWhatIsKnownToWhatThePointsSay) {
  EXPECT_NEAR(CalibrateRadialDistortion(DriveRoundABend(3), 3).correction.border_px(), 3, 1);
  EXPECT_NEAR(CalibrateRadialDistortion(DriveRoundABend(-3), 7).correction.border_px(), -3, 1);
  EXPECT_EQ(CalibrateRadialDistortion(DriveRoundABend(-4), 4).correction.border_px(), -4);
  // These points do not tell whether half of a pixel is left, or all of it.
  EXPECT_EQ(CalibrateRadialDistortion(DriveRoundABend(0), 0.5).correction.border_px(), 0);
  EXPECT_EQ(CalibrateRadialDistortion(DriveRoundABend(-0.5), 0.5).correction.border_px(), 0);
}

TEST(CalibrateRadialDistortion, LeavesAGoodCalibrationAlone) {
  EXPECT_EQ(CalibrateRadialDistortion(DriveRoundABend(0)).correction.border_px(), 0);
  // Less than what the deviations of corners allow for in any case.
  EXPECT_EQ(CalibrateRadialDistortion(DriveRoundABend(0.4)).correction.border_px(), 0);
}

TEST(CalibrateRadialDistortion, TellsThatTheLensIsRightWhereThePointsExcludeThatItMatters) {
  constexpr double kExact = 0.05;
  EXPECT_TRUE(CalibrateRadialDistortion(DriveRoundABend(0, 3, kExact)).is_right);
  EXPECT_FALSE(CalibrateRadialDistortion(DriveRoundABend(3, 3, kExact)).is_right);
  EXPECT_FALSE(CalibrateRadialDistortion(DriveRoundABend(0)).is_right);  // too few to exclude it
}

TEST(CalibrateRadialDistortion, IsForOneCameraAlone) {
  BaProblem problem = DriveRoundABend(3);
  problem.camera.baseline = 0.5;
  EXPECT_EQ(CalibrateRadialDistortion(problem).correction.border_px(), 0);
  problem.point_observations.clear();
  problem.camera.baseline = 0;
  EXPECT_EQ(CalibrateRadialDistortion(problem).correction.border_px(), 0);
}

TEST(CalibrateRadialDistortion, FindsNothingWhenItIsStopped) {
  int questions = 0;
  EXPECT_EQ(CalibrateRadialDistortion(DriveRoundABend(3), 0, [&] { return ++questions > 3; })
                .correction.border_px(),
            0);
}

TEST(CorrectLens, TakesPointsAndLinesOfTheLeftImagesToTheirPlaces) {
  BaProblem problem;
  problem.camera = OneCamera();
  const LensCorrection correction(problem.camera, 2);
  problem.point_observations.push_back({0, 0, {{600, 90}, 0.5, {}}});
  LineMeasurement line{{{600, 90}, {0, 90}}, Eigen::Matrix2d::Identity(), false};
  problem.line_observations.push_back({0, 0, line});
  line.camera = 1;
  problem.line_observations.push_back({0, 0, line});
  Correct(correction, problem);
  EXPECT_NEAR(problem.point_observations[0].measurement.px.x(), 598, 1e-12);
  EXPECT_LT(problem.point_observations[0].measurement.sigma_px, 0.5);
  EXPECT_NEAR(problem.line_observations[0].measurement.segment.start.x(), 598, 1e-12);
  EXPECT_NEAR(problem.line_observations[0].measurement.segment.end.x(), 2, 1e-12);
  EXPECT_EQ(problem.line_observations[1].measurement.segment.start.x(), 600);
}

}  // namespace
}  // namespace plumbline
