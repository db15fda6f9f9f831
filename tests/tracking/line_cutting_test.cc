// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/line_cutting.h"

#include "plumbline/base/random.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/optimization/pose_optimization.h"

#include "tests/tracking/cut_scene.h"
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::kSigmaPx;
using Scene = testing::CutScene;

// Of the place across the line of a point at parameter t.
Eigen::Vector3d AcrossAt(const PluckerLine& line, const PluckerLine& moved, double t) {
  const Eigen::Vector3d p = line.PointAt(t);
  const Eigen::Vector3d q = moved.PointAt(moved.ParameterOf(p));
  return (q - p) - line.direction * line.direction.dot(q - p);
}

TEST(CovariancesOfEnds, AreThoseOfRandomLinesWithThatInformation) {
  const Scene scene;
  const LineModel& model = scene.models[0];
  const OrthonormalLine orthonormal = ToOrthonormal(model.line);
  const Eigen::Matrix4d covariance = model.information.inverse();
  const Eigen::Matrix4d root = covariance.llt().matrixL();
  Rng rng(3, "ends");
  Eigen::Matrix3d start = Eigen::Matrix3d::Zero(), end = start;
  constexpr int kSamples = 20000;
  constexpr double kScale = 1e-3;  // so small that the line moves linearly
  for (int i = 0; i < kSamples; ++i) {
    Eigen::Vector4d unit;
    for (int k = 0; k < 4; ++k) unit(k) = rng.Normal();
    const PluckerLine moved = ToPlucker(Retract(orthonormal, kScale * (root * unit)));
    const Eigen::Vector3d a = AcrossAt(model.line, moved, model.start) / kScale;
    const Eigen::Vector3d b = AcrossAt(model.line, moved, model.end) / kScale;
    start += a * a.transpose() / kSamples;
    end += b * b.transpose() / kSamples;
  }
  const Rigid3 pose{ExpSo3({0.3, -0.2, 0.1}), {1, 2, 3}};
  const EndCovariances ends = CovariancesOfEnds(pose, model, LineInterval{model.start, model.end});
  const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
  const Eigen::Vector3d& d = model.line.direction;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
  for (const auto& [found, sampled] : {std::pair{ends.start, start}, std::pair{ends.end, end}}) {
    const Eigen::Matrix3d in_world = R.transpose() * found * R;
    EXPECT_LT((across * in_world * across - sampled).norm(), 0.05 * sampled.norm());
    EXPECT_NEAR(d.dot(in_world * d), sampled.trace(), 0.05 * sampled.trace());
  }
  EXPECT_LT(start.trace(), 0.1 * end.trace());  // as the scene says
}

TEST(CarriedInverseDepthCovariance, IsThatOfRandomPointsOfTheCameraThatMadeThem) {
  RectifiedCamera camera;
  camera.fx = 400;
  camera.fy = 420;
  const Rigid3 maker{ExpSo3({0.05, 0.6, -0.1}), {0.3, 0.1, 0.2}};
  const Rigid3 present{ExpSo3({-0.2, 0.1, 0.3}), {-0.4, 0.2, 0.5}};
  const Eigen::Vector3d in_world = Inverse(maker) * Eigen::Vector3d(0.4, -0.2, 3);
  constexpr double kSigma = 1e-3;
  const auto found = CarriedInverseDepthCovariance(camera, maker, present, in_world, kSigma);
  ASSERT_TRUE(found.has_value());
  Rng rng(4, "carried");
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 20000;
  const double mean_focal = 0.5 * (camera.fx + camera.fy);
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d p = maker * in_world;
    const double rho = 1 / p.z() + kSigma * rng.Normal();
    const double u = p.x() / p.z() + kSigma * mean_focal / camera.fx * rng.Normal();
    const double v = p.y() / p.z() + kSigma * mean_focal / camera.fy * rng.Normal();
    const Eigen::Vector3d moved = Inverse(maker) * (Eigen::Vector3d(u, v, 1) / rho);
    const Eigen::Vector3d error = present * moved - present * in_world;
    sampled += error * error.transpose() / kSamples;
  }
  EXPECT_LT((*found - sampled).norm(), 0.05 * sampled.norm());
  EXPECT_FALSE(CarriedInverseDepthCovariance(
      camera, maker, present, Inverse(maker) * Eigen::Vector3d(0, 0, -1), kSigma));
}

TEST(WithCutLines, KeepsThePoseOfExactMeasurements) { testing::ExpectPoseOfCutLines({}); }

TEST(WithCutLines, CutsTowardsTheEndThatIsKnown) {
  const Scene scene;
  const PoseProblem cut = scene.Cut();
  ASSERT_EQ(cut.lines.size(), scene.problem.lines.size());
  int shorter = 0;
  double ratio_sum = 0;
  for (std::size_t i = 0; i < cut.lines.size(); ++i) {
    const Segment3& whole = scene.problem.lines[i].ends;
    const Segment3& piece = cut.lines[i].ends;
    EXPECT_EQ(cut.lines[i].group, scene.problem.lines[i].group);
    EXPECT_LT(Distance(whole, piece.start) + Distance(whole, piece.end), 1e-6);
    shorter += piece.Length() < 0.99 * whole.Length();
    ratio_sum += (piece.Midpoint() - whole.start).norm() / whole.Length();
  }
  EXPECT_GT(shorter, static_cast<int>(cut.lines.size()) / 2);
  EXPECT_LT(ratio_sum / static_cast<double>(cut.lines.size()), 0.4);
}

TEST(WithCutLines, MovesMeasuredEndsToWhereThePieceShows) {
  const Scene scene;
  const RectifiedCamera& camera = scene.problem.camera;
  for (const auto& match : scene.Cut().lines) {
    const Eigen::Vector3d shift(camera.ShiftInto(match.measurement.camera), 0, 0);
    const Segment2& segment = match.measurement.segment;
    EXPECT_LT((segment.start - camera.Project(match.ends.start + shift)).norm(), 1e-6);
    EXPECT_LT((segment.end - camera.Project(match.ends.end + shift)).norm(), 1e-6);
  }
}

TEST(WithCutLines, WeightsPiecesAsAsked) {
  const Scene scene;
  const PoseProblem none = scene.Cut();
  const PoseProblem scalar = scene.Cut(LineWeighting::kScalar);
  const PoseProblem full = scene.Cut(LineWeighting::kCovariance);
  int pieces = 0;
  for (std::size_t i = 0; i < none.lines.size(); ++i) {
    const bool whole = none.lines[i].ends.Length() == scene.problem.lines[i].ends.Length();
    if (whole) continue;
    EXPECT_EQ(none.lines[i].measurement.covariance, Eigen::Matrix2d::Identity());
    const Eigen::Matrix2d& two = full.lines[i].measurement.covariance;
    EXPECT_EQ(two(0, 1), 0);
    EXPECT_GE(two.diagonal().minCoeff(), kSigmaPx * kSigmaPx);  // the floor
    const Eigen::Matrix2d& one = scalar.lines[i].measurement.covariance;
    EXPECT_NEAR(one(0, 0), 0.5 * two.trace(), 1e-9 * two.trace());
    EXPECT_EQ(one(0, 0), one(1, 1));
    ++pieces;
  }
  EXPECT_GT(pieces, 10);
}

TEST(WithCutLines, LeavesShortLinesWhole) {
  Scene scene;
  LineMeasurement& left = scene.problem.lines[0].measurement;
  left.segment.end = left.segment.start + Eigen::Vector2d(3, 2);
  const PoseProblem cut = scene.Cut();
  EXPECT_EQ(cut.lines[0].measurement.segment.end, left.segment.end);
  EXPECT_EQ(cut.lines[1].measurement.segment.end, scene.problem.lines[1].measurement.segment.end);
}

TEST(PointsThatFit, LeavesOutWhatIsFarOrBehind) {
  Scene scene;
  const RectifiedCamera& camera = scene.problem.camera;
  const Eigen::Vector3d place(0.3, -0.2, 3);
  const Eigen::Vector2d px = camera.Project(place);
  const Disparity disparity{camera.fx * camera.baseline / place.z(), 1};
  auto& points = scene.problem.points;
  points.push_back({place, {px, 1, {}}});
  points.push_back({place, {px + Eigen::Vector2d(4, 0), 1, {}}});
  points.push_back({place, {px + Eigen::Vector2d(4, 0), 2, {}}});
  points.push_back({place, {px, 1, disparity}});
  points.push_back({place, {px, 1, Disparity{disparity.px + 4, 1}}});
  points.push_back({-place, {px, 1, {}}});
  EXPECT_EQ(PointsThatFit(scene.problem, Rigid3{}, 1),
            (std::vector<bool>{true, false, true, true, false, false}));
  EXPECT_EQ(PointsThatFit(scene.problem, Rigid3{}, 10),
            (std::vector<bool>{true, true, true, true, true, false}));
}

TEST(LinesThatFit, JudgesBothImagesTogether) { testing::ExpectBothImagesJudgedTogether({}); }

}  // namespace
}  // namespace plumbline
