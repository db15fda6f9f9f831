// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/reconstruction_covariance.h"

#include "tests/initialization/track_scene.h"
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace plumbline {
namespace reconstruction_covariance_test {

using testing::CurvedMotion;
using testing::MakeTrackScene;
using testing::TrackScene;

constexpr double kMaxChi2 = 25;
constexpr double kSigma = 5e-4;

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// What bundle adjustment makes of many draws of the noise spreads as the covariance says.
TEST(ComputeCovariance, IsThatOfManyDraws) {
  const std::vector<Rigid3> poses = CurvedMotion(3);
  const TrackScene exact = MakeTrackScene(1, poses, {.points = 80});
  FeatureTracks tracks = exact.tracks;
  for (double& sigma : tracks.reference.sigmas) sigma = kSigma;
  for (ViewPoints& view : tracks.views) view.sigmas = tracks.reference.sigmas;
  const auto covariance = ComputeCovariance(tracks, exact.truth, 1, kMaxChi2);
  ASSERT_TRUE(covariance);
  constexpr int kDraws = 150;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d direction = Eigen::Matrix3d::Zero();
  std::vector<double> relative_depths;
  const Eigen::Vector3d centre = Inverse(poses.back()).translation.normalized();
  for (int draw = 0; draw < kDraws; ++draw) {
    Rng rng(9, "draw", static_cast<std::uint64_t>(draw));
    FeatureTracks noisy = tracks;
    for (Eigen::Vector2d& place : noisy.reference.points) place += RandomVector<2>(rng, kSigma);
    for (ViewPoints& view : noisy.views) {
      for (Eigen::Vector2d& place : view.points) place += RandomVector<2>(rng, kSigma);
    }
    Reconstruction solved = BundleAdjust(noisy, exact.truth, 15);
    const Rigid3& newest = solved.cam_from_reference.back();
    const Eigen::Vector3d w = LogSo3(newest.rotation * poses.back().rotation.conjugate());
    rotation += w * w.transpose() / kDraws;
    // In the camera's axes, as the perturbation is.
    const Eigen::Vector3d turned =
        newest.rotation * (Inverse(newest).translation.normalized() - centre);
    direction += turned * turned.transpose() / kDraws;
    std::vector<double> ratios;
    for (std::size_t k = 0; k < solved.points.size(); ++k) {
      ratios.push_back(solved.points[k].z() / exact.truth.points[k].z());
    }
    const double scale = Median(ratios);
    for (const double ratio : ratios) relative_depths.push_back(std::abs(ratio / scale - 1));
  }
  const int last = static_cast<int>(poses.size()) - 1;
  const Eigen::Matrix3d predicted = covariance->poses.block<3, 3>(6 * last, 6 * last);
  EXPECT_NEAR(std::sqrt(rotation.trace() / predicted.trace()), 1, 0.15);
  const PoseAccuracy accuracy = AccuracyOf(exact.truth, *covariance, last);
  const auto largest = [](const Eigen::Matrix3d& m) {
    return std::sqrt(
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues()(2));
  };
  EXPECT_NEAR(accuracy.rotation, largest(predicted), 1e-12);
  EXPECT_NEAR(largest(direction) / accuracy.direction, 1, 0.2);
  // The median of the absolute value of a normal variable is 0.6745 of its deviation.
  const double depth = Median(covariance->relative_depth_sigmas);
  EXPECT_NEAR(Median(relative_depths) / (0.6745 * depth), 1, 0.2);
}

// The same where most is known by lines.
TEST(ComputeCovariance, IsThatOfManyDrawsWithLines) {
  const std::vector<Rigid3> poses = CurvedMotion(3);
  const TrackScene exact = MakeTrackScene(5, poses, {.points = 14, .lines = 30});
  const auto covariance = ComputeCovariance(exact.tracks, exact.truth, 1, kMaxChi2);
  ASSERT_TRUE(covariance);
  constexpr int kDraws = 100;
  constexpr double kSceneSigma = 1e-3;
  const auto disturb = [](Rng& rng, ViewPoints& points, ViewLines& lines) {
    for (Eigen::Vector2d& place : points.points) place += RandomVector<2>(rng, kSceneSigma);
    for (Segment2& segment : lines.segments) {
      segment.start += RandomVector<2>(rng, kSceneSigma);
      segment.end += RandomVector<2>(rng, kSceneSigma);
    }
  };
  double squares = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Rng rng(10, "draw", static_cast<std::uint64_t>(draw));
    FeatureTracks noisy = exact.tracks;
    disturb(rng, noisy.reference, noisy.lines.reference);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      disturb(rng, noisy.views[i], noisy.lines.views[i]);
    }
    const Reconstruction solved = BundleAdjust(noisy, exact.truth, 15);
    const Eigen::Quaterniond& found = solved.cam_from_reference.back().rotation;
    squares += LogSo3(found * poses.back().rotation.conjugate()).squaredNorm() / kDraws;
  }
  const double predicted = covariance->poses.block<3, 3>(12, 12).trace();
  EXPECT_NEAR(std::sqrt(squares / predicted), 1, 0.2);
  Reconstruction without = exact.truth;
  without.lines.clear();
  const auto points_alone = ComputeCovariance(exact.tracks, without, 1, kMaxChi2);
  ASSERT_TRUE(points_alone);
  const double by_points = points_alone->poses.block<3, 3>(12, 12).trace();
  EXPECT_GT(by_points, 1.2 * predicted);
}

TEST(ComputeCovariance, GrowsWithTheNoise) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3));
  const auto one = ComputeCovariance(scene.tracks, scene.truth, 1, kMaxChi2);
  const auto two = ComputeCovariance(scene.tracks, scene.truth, 2, kMaxChi2);
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(two->poses.trace() / one->poses.trace(), 4, 1e-6);
}

TEST(ComputeCovariance, SaysThatATurningCameraKnowsNoDepth) {
  std::vector<Rigid3> poses = CurvedMotion(3, 1e-4);
  const TrackScene scene = MakeTrackScene(3, poses);
  const auto covariance = ComputeCovariance(scene.tracks, scene.truth, 1, kMaxChi2);
  if (covariance) {
    EXPECT_GT(Median(covariance->relative_depth_sigmas), 1);
    EXPECT_GT(AccuracyOf(scene.truth, *covariance, 2).direction, 0.5);
  }
  TrackScene empty = MakeTrackScene(4, poses, {.points = 2});
  EXPECT_FALSE(ComputeCovariance(empty.tracks, empty.truth, 1, kMaxChi2));
}

}  // namespace reconstruction_covariance_test
}  // namespace plumbline
