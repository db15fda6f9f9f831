// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/measurements.h"

#include "plumbline/matching/landmark_from_frame.h"
#include "plumbline/optimization/residuals.h"

#include "tests/matching/line_scene.h"
#include "tests/support/jacobian.h"
#include "tests/support/synthetic_world.h"
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::kExact;
using testing::kLevel;
using testing::kSlanted;
using testing::LineScene;

Rigid3 SomePose() { return {ExpSo3({0.1, -0.15, 0.05}), {0.3, -0.2, 0.1}}; }

TEST(Measurements, CarryTheFeaturesNoise) {
  Features features;
  features.points.push_back({.px = {10, 20}, .sigma_px = 1.4});
  features.point_disparity.push_back(Disparity{7, 0.2});
  features.lines.push_back({.segment = {{1, 2}, {3, 4}}, .sigma_px = 0.6});
  features.line_right.push_back(MeasuredSegment{{{0, 2}, {2, 4}}, 0.9});
  const PointMeasurement point = MeasurePoint(features, 0);
  EXPECT_EQ(point.px, Eigen::Vector2d(10, 20));
  EXPECT_EQ(point.sigma_px, 1.4);
  EXPECT_EQ(point.disparity->px, 7);
  for (const LineWeighting weighting : {LineWeighting::kScalar, LineWeighting::kCovariance}) {
    const LineMeasurement left = MeasureLeftLine(features, 0, weighting);
    EXPECT_EQ(left.camera, 0);
    EXPECT_TRUE(left.covariance.isApprox(0.36 * Eigen::Matrix2d::Identity()));
    const auto right = MeasureRightLine(features, 0, weighting);
    ASSERT_TRUE(right);
    EXPECT_EQ(right->camera, 1);
    EXPECT_EQ(right->segment.end, Eigen::Vector2d(2, 4));
    EXPECT_TRUE(right->covariance.isApprox(0.81 * Eigen::Matrix2d::Identity()));
  }
  EXPECT_TRUE(MeasureLeftLine(features, 0, LineWeighting::kNone).covariance.isIdentity());
  EXPECT_TRUE(MeasureRightLine(features, 0, LineWeighting::kNone)->covariance.isIdentity());
  const LineWeights constant(LineWeighting::kNone, 0.3);
  EXPECT_TRUE(MeasureLeftLine(features, 0, constant)
                  .covariance.isApprox(0.09 * Eigen::Matrix2d::Identity()));
  EXPECT_TRUE(MeasureRightLine(features, 0, constant)
                  ->covariance.isApprox(0.09 * Eigen::Matrix2d::Identity()));
  features.line_right.Set(0, std::nullopt);
  EXPECT_FALSE(MeasureRightLine(features, 0, LineWeighting::kNone));
}

TEST(LineInformation, IsJtjOfNumericallyDifferentiatedDistances) {
  const LineScene scene(kSlanted, {.missed = 0}, SomePose());
  const Features& features = scene.frame.features();
  ASSERT_TRUE(features.line_right[0]);
  const OrthonormalLine line = ToOrthonormal(scene.line);
  // Signed distances of the four measured end points from the projections of the line.
  const auto distances = [&](const Eigen::Vector4d& delta) {
    const PluckerLine in_cam = Transform(scene.cam_from_world, ToPlucker(Retract(line, delta)));
    Eigen::Vector4d d;
    for (const bool right : {false, true}) {
      const Eigen::Vector3d shift(right ? -scene.world.camera.baseline : 0, 0, 0);
      const Eigen::Vector3d moment = in_cam.moment + shift.cross(in_cam.direction);
      Eigen::Vector3d l = scene.world.camera.ProjectMoment(moment);
      l /= l.head<2>().norm();
      const Segment2& s = right ? features.line_right[0]->segment : features.lines[0].segment;
      d.segment<2>(right ? 2 : 0) << LineDistance(l, s.start), LineDistance(l, s.end);
    }
    return d;
  };
  const Eigen::Matrix4d J = NumericJacobian(distances, Eigen::Vector4d(Eigen::Vector4d::Zero()));
  const Eigen::Matrix4d expected = J.transpose() * J / (0.4 * 0.4);
  const Eigen::Matrix4d information =
      LineInformation(scene.world.camera, scene.frame, 0, scene.line);
  EXPECT_LT((information - expected).norm(), 1e-6 * expected.norm());
}

TEST(LineInformation, AddsUpOverViewsAndIsSingularForOneImage) {
  const LineScene stereo(kSlanted, kExact);
  SensorModel mono = kExact;
  mono.depth = false;
  const LineScene single(kSlanted, mono);
  const auto rank = [](const Eigen::Matrix4d& m) {
    const Eigen::Vector4d e = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(m).eigenvalues();
    return (e.array() > 1e-9 * e(3)).count();
  };
  EXPECT_EQ(rank(LineInformation(single.world.camera, single.frame, 0, single.line)), 2);
  EXPECT_EQ(rank(LineInformation(stereo.world.camera, stereo.frame, 0, stereo.line)), 4);
}

TEST(SigmaAt, IsTheSpreadOfRandomLinesWithThatInformation) {
  const LineScene scene(kSlanted, kExact, SomePose());
  // Known a hundred times better than from one pair, so that first order holds.
  const Eigen::Matrix4d information =
      1e4 * LineInformation(scene.world.camera, scene.frame, 0, scene.line);
  const Eigen::Matrix4d root =
      Eigen::LLT<Eigen::Matrix4d>(information.inverse()).matrixL().toDenseMatrix();
  const OrthonormalLine line = ToOrthonormal(scene.line);
  for (const double along : {0.0, 0.5, 1.5}) {
    const double t = scene.line.ParameterOf(scene.segment.start +
                                            along * (scene.segment.end - scene.segment.start));
    const Eigen::Vector3d place = scene.line.PointAt(t);
    Rng rng(5, "sigma_at");
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    const int samples = 4000;
    for (int i = 0; i < samples; ++i) {
      const PluckerLine moved = ToPlucker(Retract(line, root * RandomVector<4>(rng)));
      // Where the moved line crosses the plane through the place, normal to the line.
      const double to_plane = scene.line.direction.dot(place - moved.Foot()) /
                              scene.line.direction.dot(moved.direction);
      const Eigen::Vector3d offset = moved.PointAt(to_plane) - place;
      covariance += offset * offset.transpose() / samples;
    }
    const double expected =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()(2));
    EXPECT_NEAR(SigmaAt(scene.line, information, t), expected, 0.06 * expected) << along;
  }
}

TEST(SigmaAt, IsInfiniteWhereNothingIsKnown) {
  const LineScene scene(kSlanted, kExact);
  EXPECT_TRUE(std::isinf(SigmaAt(scene.line, Eigen::Matrix4d::Zero(), 0)));
}

TEST(ShiftJacobian, IsTheDerivativeOfThePlace) {
  const LineScene scene(kSlanted, kExact);
  const OrthonormalLine line = ToOrthonormal(scene.line);
  constexpr double kStep = 1e-6;
  for (const double t : {-0.7, 0.0, 1.9}) {
    const Eigen::Vector3d place = scene.line.PointAt(t);
    const auto shift = [&](const Eigen::Vector4d& tangent) -> Eigen::Vector3d {
      const PluckerLine moved = ToPlucker(Retract(line, tangent));
      const double to_plane = scene.line.direction.dot(place - moved.Foot()) /
                              scene.line.direction.dot(moved.direction);
      return moved.PointAt(to_plane) - place;
    };
    const Eigen::Matrix<double, 3, 4> J = ShiftJacobian(scene.line, line, t);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(k);
      EXPECT_LT((J.col(k) - (shift(step) - shift(-step)) / (2 * kStep)).norm(), 1e-7) << t;
    }
  }
}

// Covariance of the two end point distances from the projections of random lines.
Eigen::Matrix2d SampledDistances(const LineScene& scene,
                                 const Eigen::Matrix4d& information,
                                 const LineMeasurement& measurement) {
  const Eigen::Matrix4d root =
      Eigen::LLT<Eigen::Matrix4d>(information.inverse()).matrixL().toDenseMatrix();
  const OrthonormalLine line = ToOrthonormal(scene.line);
  LineMeasurement unit = measurement;
  unit.covariance.setIdentity();
  Rng rng(6, "uncertainty");
  const int samples = 4000;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (int i = 0; i < samples; ++i) {
    const OrthonormalLine moved = Retract(line, root * RandomVector<4>(rng));
    const auto residual = EvaluateLine(scene.world.camera, scene.cam_from_world, moved, unit);
    covariance += residual->r * residual->r.transpose() / samples;
  }
  return covariance;
}

TEST(AddLandmarkUncertainty, IsTheSpreadOfTheProjectedLine) {
  const LineScene scene(kSlanted, kExact);
  // Known ten times better than from one pair, so that first order holds.
  const Eigen::Matrix4d information =
      100 * LineInformation(scene.world.camera, scene.frame, 0, scene.line);
  // Seen from elsewhere, where the depth error shows.
  const LineScene later(kSlanted, kExact, Inverse(Rigid3{ExpSo3({0, -0.1, 0}), {0.8, 0.1, 0.2}}));
  const LineMeasurement before =
      MeasureLeftLine(later.frame.features(), 0, LineWeighting::kCovariance);
  LineMeasurement after = before;
  AddLandmarkUncertainty(later.world.camera,
                         later.cam_from_world,
                         later.line,
                         information,
                         LineWeighting::kCovariance,
                         after);
  const Eigen::Matrix2d added = after.covariance - before.covariance;
  const Eigen::Matrix2d expected = SampledDistances(later, information, before);
  EXPECT_GT(expected.trace(), 0.05);  // px^2: not a test of nothing
  EXPECT_LT((added - expected).norm(), 0.1 * expected.norm());
}

TEST(AddLandmarkUncertainty, FollowsTheWeighting) {
  const LineScene scene(kSlanted, kExact);
  const Eigen::Matrix4d information =
      LineInformation(scene.world.camera, scene.frame, 0, scene.line);
  const auto with = [&](LineWeighting weighting) {
    LineMeasurement m = MeasureLeftLine(scene.frame.features(), 0, weighting);
    AddLandmarkUncertainty(
        scene.world.camera, scene.cam_from_world, scene.line, information, weighting, m);
    return m.covariance;
  };
  EXPECT_TRUE(with(LineWeighting::kNone).isIdentity());
  const Eigen::Matrix2d full = with(LineWeighting::kCovariance);
  const Eigen::Matrix2d scalar = with(LineWeighting::kScalar);
  EXPECT_NE(full(0, 1), 0);
  EXPECT_TRUE(scalar.isApprox(0.5 * full.trace() * Eigen::Matrix2d::Identity(), 1e-12));
}

TEST(AddLandmarkUncertainty, StaysFiniteWithoutInformation) {
  const LineScene scene(kSlanted, kExact, SomePose());
  LineMeasurement m = MeasureLeftLine(scene.frame.features(), 0, LineWeighting::kCovariance);
  AddLandmarkUncertainty(scene.world.camera,
                         scene.cam_from_world,
                         scene.line,
                         Eigen::Matrix4d::Zero(),
                         LineWeighting::kCovariance,
                         m);
  EXPECT_TRUE(m.covariance.allFinite());
  EXPECT_GT(m.covariance.determinant(), 0);
  EXPECT_GT(m.covariance.trace(), 1000);  // a line that may be anywhere says next to nothing
}

// Seen end on, a line's image turns wildly with its least move, which must not drown the deviations
// of its measured ends.
TEST(AddLandmarkUncertainty, StaysPositiveDefiniteWhereTheLinePassesThroughTheCamera) {
  const LineScene scene(kSlanted, kExact);
  const Eigen::Matrix4d information =
      1e6 * LineInformation(scene.world.camera, scene.frame, 0, scene.line);
  for (const double away : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    const Eigen::Vector3d centre = kSlanted.start + Eigen::Vector3d(0, away, 0);
    LineMeasurement m = MeasureLeftLine(scene.frame.features(), 0, LineWeighting::kCovariance);
    AddLandmarkUncertainty(scene.world.camera,
                           {Eigen::Quaterniond::Identity(), -centre},
                           scene.line,
                           information,
                           LineWeighting::kCovariance,
                           m);
    EXPECT_NO_THROW(MakeLineTerm(scene.world.camera, m)) << away;
  }
}

TEST(PointFromFrame, FindsTheTruePointWithItsLooks) {
  SyntheticWorld world;
  world.points.push_back({{0.7, -0.4, 5}, Descriptor{9, 8, 7, 6}});
  Rng rng(1);
  const Rigid3 pose = SomePose();
  const SyntheticFrame sensed = Sense(world, pose, kExact, rng);
  const Frame frame = MakeFrame(FrameId{0}, pose, sensed);
  const auto point = PointFromFrame(world.camera, frame, 0, 0.2);
  ASSERT_TRUE(point);
  EXPECT_LT((point->position - world.points[0].position).norm(), 1e-9);
  const Eigen::Vector3d from_camera = world.points[0].position - Inverse(pose).translation;
  EXPECT_LT((point->view_direction - from_camera.normalized()).norm(), 1e-9);
  EXPECT_NEAR(point->reference_distance, from_camera.norm(), 1e-9);
  EXPECT_EQ(point->reference_octave, frame.features().points[0].octave);
  EXPECT_EQ(point->descriptor, world.points[0].descriptor);
  // sigma / disparity is 0.3 / 9.6.
  EXPECT_FALSE(PointFromFrame(world.camera, frame, 0, 0.02));
}

// Against the derivative of the place by pixel and disparity.
TEST(PointFromFrame, CovarianceIsThatOfPixelAndDisparity) {
  SyntheticWorld world;
  world.points.push_back({{0.7, -0.4, 5}, {}});
  Rng rng(1);
  const Rigid3 pose = SomePose();
  const SyntheticFrame sensed = Sense(world, pose, kExact, rng);
  const Frame frame = MakeFrame(FrameId{0}, pose, sensed);
  const PointFeature& feature = frame.features().points[0];
  const Disparity& disparity = *frame.features().point_disparity[0];
  const auto place = [&](const Eigen::Vector3d& by) -> Eigen::Vector3d {
    return Inverse(pose) * (world.camera.DepthFromDisparity(disparity.px + by.z()) *
                            world.camera.Unproject(feature.px + by.head<2>()));
  };
  const Eigen::Vector3d sigma(feature.sigma_px, feature.sigma_px, disparity.sigma_px);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = 1e-5 * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d moved = sigma(i) * (place(step) - place(-step)) / 2e-5;
    expected += moved * moved.transpose();
  }
  const Eigen::Matrix3d covariance = PointCovarianceFromFrame(world.camera, frame, 0);
  EXPECT_LT((covariance - expected).norm(), 1e-6 * expected.norm());
}

TEST(PointFromFrame, NeedsADepth) {
  SyntheticWorld world;
  world.points.push_back({{0.7, -0.4, 5}, {}});
  SensorModel mono = kExact;
  mono.depth = false;
  Rng rng(1);
  const Frame frame = MakeFrame(FrameId{0}, {}, Sense(world, {}, mono, rng));
  EXPECT_FALSE(PointFromFrame(world.camera, frame, 0, 1));
}

TEST(LineFromFrame, FindsTheTrueLineWithItsLooks) {
  const LineScene scene(kSlanted, kExact, SomePose());
  const auto model = LineFromFrame(scene.world.camera, scene.frame, 0, 0.3);
  ASSERT_TRUE(model);
  EXPECT_LT(model->line.DistanceTo(kSlanted.start), 1e-9);
  EXPECT_LT(model->line.DistanceTo(kSlanted.end), 1e-9);
  EXPECT_GT(model->line.direction.dot(kSlanted.Direction()), 1 - 1e-12);
  // The interval is what was seen: up to a tenth less at each end.
  const double length = kSlanted.Length();
  EXPECT_NEAR((model->Interval().start - kSlanted.start).norm(), 0.05 * length, 0.0501 * length);
  EXPECT_NEAR((model->Interval().end - kSlanted.end).norm(), 0.05 * length, 0.0501 * length);
  EXPECT_LT(model->start, model->end);
  EXPECT_EQ(model->descriptor, (Descriptor{1, 2, 3, 4}));
  EXPECT_TRUE(model->information.isApprox(
      LineInformation(scene.world.camera, scene.frame, 0, model->line), 1e-12));
  EXPECT_FALSE(LineFromFrame(scene.world.camera, scene.frame, 0, 0.01));
}

TEST(LineFromFrame, GivesNothingForLinesAlongTheRowsOrInOneImage) {
  const LineScene level(kLevel, kExact);
  ASSERT_TRUE(level.frame.features().line_right[0]);
  EXPECT_FALSE(LineFromFrame(level.world.camera, level.frame, 0, 1));
  SensorModel mono = kExact;
  mono.depth = false;
  const LineScene single(kSlanted, mono);
  EXPECT_FALSE(LineFromFrame(single.world.camera, single.frame, 0, 1));
}

}  // namespace
}  // namespace plumbline
