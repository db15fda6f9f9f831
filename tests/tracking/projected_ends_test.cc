// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/projected_ends.h"

#include "tests/optimization/random_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::AddNoise;
using testing::MeasureLine;
using testing::Random;
using testing::StereoCamera;

struct View {
  RectifiedCamera camera = StereoCamera();
  Rigid3 cam_from_world;
  Segment3 segment;
  OrthonormalLine line;
  LineInterval interval;
};

View RandomView(Random& random) {
  View view;
  view.cam_from_world = ExpSe3(random.Twist(1.0, 2.0));
  const Rigid3 world_from_cam = Inverse(view.cam_from_world);
  view.segment = {world_from_cam * random.PointInView(view.camera),
                  world_from_cam * random.PointInView(view.camera)};
  const PluckerLine line = LineThroughPoints(view.segment.start, view.segment.end);
  view.line = ToOrthonormal(line);
  view.interval = {line.ParameterOf(view.segment.start), line.ParameterOf(view.segment.end)};
  return view;
}

TEST(ProjectedEnds, AreAsFarFromTheMeasuredLineAsItWasShifted) {
  const RectifiedCamera camera = StereoCamera();
  const Segment3 segment{{-1, 0.2, 5}, {1, 0.2, 5}};  // horizontal in the image
  const PluckerLine line = LineThroughPoints(segment.start, segment.end);
  for (const bool right : {false, true}) {
    LineMeasurement m = MeasureLine(camera, {}, segment, right, 1);
    m.segment.start.y() += 2;
    m.segment.end.y() += 2;
    const auto residual =
        EvaluateProjectedEnds(camera,
                              {},
                              ToOrthonormal(line),
                              {line.ParameterOf(segment.start), line.ParameterOf(segment.end)},
                              m);
    ASSERT_TRUE(residual);
    EXPECT_NEAR(std::abs(residual->r(0)), 2, 1e-9);
    EXPECT_NEAR(residual->r(0), residual->r(1), 1e-9);
  }
}

TEST(ProjectedEnds, JacobiansAgreeWithCentralDifferences) {
  Random random(1);
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 40; ++trial) {
    const View view = RandomView(random);
    LineMeasurement m =
        MeasureLine(view.camera, view.cam_from_world, view.segment, trial % 2 == 1, 1);
    AddNoise(random, 5, m);
    m.covariance << 1.3, 0.4, 0.4, 0.8;
    const auto at = [&](const Rigid3& pose, const OrthonormalLine& line) {
      return EvaluateProjectedEnds(view.camera, pose, line, view.interval, m);
    };
    const auto residual = at(view.cam_from_world, view.line);
    ASSERT_TRUE(residual);
    Eigen::Matrix<double, 2, 6> by_pose;
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = kStep * Vector6d::Unit(k);
      by_pose.col(k) = (at(RetractLeft(view.cam_from_world, step), view.line)->r -
                        at(RetractLeft(view.cam_from_world, -step), view.line)->r) /
                       (2 * kStep);
    }
    EXPECT_LT((residual->J_pose - by_pose).norm(), 1e-6 * (1 + by_pose.norm()));
    Eigen::Matrix<double, 2, 4> by_line;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(k);
      by_line.col(k) = (at(view.cam_from_world, Retract(view.line, step))->r -
                        at(view.cam_from_world, Retract(view.line, -step))->r) /
                       (2 * kStep);
    }
    EXPECT_LT((residual->J_line - by_line).norm(), 1e-6 * (1 + by_line.norm()));
  }
}

TEST(ProjectedEnds, HaveNoResidualBehindTheCamera) {
  const RectifiedCamera camera = StereoCamera();
  const PluckerLine line = LineThroughPoints({0.5, 0, -1}, {0.5, 0.2, 4});
  LineMeasurement m;
  m.segment = {{100, 100}, {200, 150}};
  const LineInterval interval{line.ParameterOf({0.5, 0, -1}), line.ParameterOf({0.5, 0.2, 4})};
  EXPECT_FALSE(EvaluateProjectedEnds(camera, {}, ToOrthonormal(line), interval, m));
}

TEST(ProjectedEnds, AMeasurementWithoutDirectionHasNoResidual) {
  LineMeasurement m;
  m.segment = {{100, 100}, {100, 100}};
  const ProjectedEndsTerm term = MakeProjectedEndsTerm(StereoCamera(), m);
  ProjectedEndsLinearization lin;
  EXPECT_FALSE(LinearizeProjectedEnds(term, {{0, 0, 4}, {1, 0, 4}}, lin));
}

// Of many noisy measurements, the covariance of the distances of ends that see another part of the
// line than was measured.
TEST(ProjectedEnds, CovarianceIsThatOfManyMeasurements) {
  Random random(2);
  const RectifiedCamera camera = StereoCamera();
  const Segment3 measured{{-1, 0.2, 5}, {0.5, 0.6, 6}};
  const PluckerLine line = LineThroughPoints(measured.start, measured.end);
  const LineInterval interval{line.ParameterOf(measured.start) - 0.4,
                              line.ParameterOf(measured.end) + 0.8};
  LineMeasurement exact = MeasureLine(camera, {}, measured, false, 1);
  exact.covariance << 0.25, 0, 0, 1;
  const Eigen::Matrix2d predicted =
      ProjectedEndsCovariance(camera, {}, SegmentOf(line, interval), exact);
  const Eigen::Vector2d along = exact.segment.Direction();
  const Eigen::Vector2d across(-along.y(), along.x());
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  constexpr int kTrials = 20000;
  for (int i = 0; i < kTrials; ++i) {
    LineMeasurement m = exact;
    m.covariance.setIdentity();
    m.segment.start += random.Normal(0.5) * across;
    m.segment.end += random.Normal(1) * across;
    const auto r = EvaluateProjectedEnds(camera, {}, ToOrthonormal(line), interval, m)->r;
    sum += r * r.transpose();
  }
  EXPECT_LT((sum / kTrials - predicted).norm(), 0.05 * predicted.norm());
}

TEST(ProjectedEnds, CovarianceStaysRegularWhereTheEndsMeet) {
  const RectifiedCamera camera = StereoCamera();
  const Segment3 segment{{-1, 0.2, 5}, {1, 0.5, 6}};
  const LineMeasurement m = MeasureLine(camera, {}, segment, false, 1);
  const Eigen::Matrix2d covariance =
      ProjectedEndsCovariance(camera, {}, {segment.start, segment.start}, m);
  EXPECT_GT(covariance.determinant(), 0);
}

}  // namespace
}  // namespace plumbline
