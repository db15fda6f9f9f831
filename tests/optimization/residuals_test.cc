// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/residuals.h"

#include "plumbline/base/error.h"

#include "tests/optimization/random_scene.h"
#include <functional>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {

namespace residuals_test {

using testing::AddNoise;
using testing::MeasureLine;
using testing::MeasurePoint;
using testing::Random;
using testing::StereoCamera;

template <int kRows, int kCols>
Eigen::Matrix<double, kRows, kCols> CentralDifferences(
    const std::function<Eigen::Matrix<double, kRows, 1>(const Eigen::Matrix<double, kCols, 1>&)>& f,
    double h) {
  Eigen::Matrix<double, kRows, kCols> J;
  for (int i = 0; i < kCols; ++i) {
    const Eigen::Matrix<double, kCols, 1> step = h * Eigen::Matrix<double, kCols, 1>::Unit(i);
    J.col(i) = (f(step) - f(-step)) / (2 * h);
  }
  return J;
}

// Relative to the largest entry of the derivative.
template <class A, class B>
void ExpectClose(const A& actual, const B& expected, double tolerance) {
  const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
  EXPECT_LT((actual - expected).cwiseAbs().maxCoeff() / scale, tolerance)
      << "actual\n"
      << actual << "\nexpected\n"
      << expected;
}

struct View {
  RectifiedCamera camera = StereoCamera();
  Rigid3 cam_from_world;
  Eigen::Vector3d point;
  Segment3 segment;
};

View RandomView(Random& random) {
  View view;
  view.cam_from_world = ExpSe3(random.Twist(1.0, 2.0));
  const Rigid3 world_from_cam = Inverse(view.cam_from_world);
  view.point = world_from_cam * random.PointInView(view.camera);
  view.segment.start = world_from_cam * random.PointInView(view.camera);
  view.segment.end = world_from_cam * random.PointInView(view.camera);
  return view;
}

LineMeasurement NoisyLine(Random& random, const View& view, bool right) {
  LineMeasurement m = MeasureLine(view.camera, view.cam_from_world, view.segment, right, 1);
  AddNoise(random, 5, m);
  m.covariance << 1.3, 0.4, 0.4, 0.8;
  return m;
}

TEST(PointResidual, VanishesForTheExactMeasurement) {
  Random random(1);
  const View view = RandomView(random);
  const auto m = MeasurePoint(view.camera, view.cam_from_world, view.point, true, 0.7);
  const auto residual = EvaluatePoint(view.camera, view.cam_from_world, view.point, m);
  ASSERT_TRUE(residual);
  EXPECT_LT(residual->r.norm(), 1e-10);
}

TEST(PointResidual, RowsAreMeasuredMinusPredictedInSigmas) {
  const RectifiedCamera camera = StereoCamera();
  const Eigen::Vector3d point(0.3, -0.2, 4);
  PointMeasurement m = MeasurePoint(camera, {}, point, true, 2);
  m.px += Eigen::Vector2d(4, -6);
  m.disparity->px += 1;
  m.disparity->sigma_px = 0.5;
  const auto residual = EvaluatePoint(camera, {}, point, m);
  ASSERT_TRUE(residual);
  EXPECT_LT((residual->r - Eigen::Vector3d(2, -3, 2)).norm(), 1e-10);
  EXPECT_EQ(residual->rows, 3);
  m.disparity.reset();
  const auto mono = EvaluatePoint(camera, {}, point, m);
  EXPECT_EQ(mono->rows, 2);
  EXPECT_EQ(mono->r.z(), 0);
}

TEST(PointResidual, JacobiansAgreeWithCentralDifferences) {
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const View view = RandomView(random);
    auto m = MeasurePoint(view.camera, view.cam_from_world, view.point, trial % 2 == 0, 0.7);
    AddNoise(random, 3, m);
    const auto at = EvaluatePoint(view.camera, view.cam_from_world, view.point, m);
    ASSERT_TRUE(at);
    const auto by_pose = CentralDifferences<3, 6>(
        [&](const Vector6d& d) -> Eigen::Vector3d {
          return EvaluatePoint(view.camera, RetractLeft(view.cam_from_world, d), view.point, m)->r;
        },
        1e-6);
    ExpectClose(at->J_pose, by_pose, 1e-7);
    const auto by_point = CentralDifferences<3, 3>(
        [&](const Eigen::Vector3d& d) -> Eigen::Vector3d {
          return EvaluatePoint(view.camera, view.cam_from_world, view.point + d, m)->r;
        },
        1e-6);
    ExpectClose(at->J_point, by_point, 1e-7);
  }
}

TEST(PointResidual, IsAbsentBehindTheCamera) {
  const RectifiedCamera camera = StereoCamera();
  EXPECT_FALSE(EvaluatePoint(camera, {}, {0, 0, -1}, {}));
  EXPECT_FALSE(EvaluatePoint(camera, {}, {0, 0, 0}, {}));
}

TEST(PointResidual, SigmaMustBePositive) {
  EXPECT_THROW(MakePointTerm({.px = {1, 1}, .sigma_px = 0, .disparity = std::nullopt}), BugError);
}

TEST(LineResidual, VanishesForTheExactMeasurementInBothCameras) {
  Random random(3);
  for (const bool right : {false, true}) {
    const View view = RandomView(random);
    const auto m = MeasureLine(view.camera, view.cam_from_world, view.segment, right, 1);
    const auto line = ToOrthonormal(LineThroughPoints(view.segment.start, view.segment.end));
    const auto residual = EvaluateLine(view.camera, view.cam_from_world, line, m);
    ASSERT_TRUE(residual);
    EXPECT_LT(residual->r.norm(), 1e-9);
  }
}

TEST(LineResidual, IsTheDistanceOfTheEndPointsInPixels) {
  const RectifiedCamera camera = StereoCamera();
  const Segment3 segment{{-1, 0.2, 5}, {1, 0.2, 5}};  // horizontal in the image
  LineMeasurement m = MeasureLine(camera, {}, segment, false, 1);
  m.segment.start.y() += 2;
  m.segment.end.y() -= 3;
  const auto line = ToOrthonormal(LineThroughPoints(segment.start, segment.end));
  const auto residual = EvaluateLine(camera, {}, line, m);
  ASSERT_TRUE(residual);
  EXPECT_NEAR(std::abs(residual->r(0)), 2, 1e-9);
  EXPECT_NEAR(std::abs(residual->r(1)), 3, 1e-9);
  EXPECT_LT(residual->r(0) * residual->r(1), 0);
}

TEST(LineResidual, WhiteningGivesTheMahalanobisNorm) {
  Random random(4);
  const View view = RandomView(random);
  LineMeasurement m = NoisyLine(random, view, false);
  const auto line = ToOrthonormal(LineThroughPoints(view.segment.start, view.segment.end));
  const auto white = EvaluateLine(view.camera, view.cam_from_world, line, m);
  const Eigen::Matrix2d covariance = m.covariance;
  m.covariance.setIdentity();
  const auto plain = EvaluateLine(view.camera, view.cam_from_world, line, m);
  ASSERT_TRUE(white && plain);
  EXPECT_NEAR(white->r.squaredNorm(), plain->r.dot(covariance.inverse() * plain->r), 1e-9);
}

TEST(LineResidual, JacobiansAgreeWithCentralDifferences) {
  Random random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const View view = RandomView(random);
    const LineMeasurement m = NoisyLine(random, view, trial % 2 == 1);
    const auto line = ToOrthonormal(LineThroughPoints(view.segment.start, view.segment.end));
    const auto at = EvaluateLine(view.camera, view.cam_from_world, line, m);
    ASSERT_TRUE(at);
    const auto by_pose = CentralDifferences<2, 6>(
        [&](const Vector6d& d) -> Eigen::Vector2d {
          return EvaluateLine(view.camera, RetractLeft(view.cam_from_world, d), line, m)->r;
        },
        1e-6);
    ExpectClose(at->J_pose, by_pose, 1e-6);
    const auto by_line = CentralDifferences<2, 4>(
        [&](const Eigen::Vector4d& d) -> Eigen::Vector2d {
          return EvaluateLine(view.camera, view.cam_from_world, Retract(line, d), m)->r;
        },
        1e-6);
    ExpectClose(at->J_line, by_line, 1e-6);
  }
}

TEST(LineResidual, IsAbsentForALineThroughTheCameraCentre) {
  const auto line = ToOrthonormal(LineThroughPoints({0, 0, 1}, {0, 0, 2}));
  EXPECT_FALSE(EvaluateLine(StereoCamera(), {}, line, {}));
}

TEST(LineResidual, CovarianceMustBePositiveDefinite) {
  LineMeasurement m;
  m.covariance << 1, 2, 2, 1;
  EXPECT_THROW(MakeLineTerm(StereoCamera(), m), BugError);
}

}  // namespace residuals_test

namespace {

using testing::AddNoise;
using testing::MeasurePoint;
using testing::Random;
using testing::StereoCamera;

// A point about 6 m away whose depth is known to half a metre, measured with a pixel.
struct Measured {
  RectifiedCamera camera = StereoCamera();
  Rigid3 pose = ExpSe3((Vector6d() << 0.1, -0.2, 0.05, 0.3, 0.1, -0.2).finished());
  Eigen::Vector3d place = Inverse(pose) * Eigen::Vector3d(1, -0.5, 6);
  Eigen::Matrix3d root = Inverse(pose).rotation.toRotationMatrix() *
                         Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()).toRotationMatrix() *
                         Eigen::Vector3d(0.01, 0.01, 0.5).asDiagonal();
  Eigen::Matrix3d covariance = root * root.transpose();

  PoseProblem::PointMatch Match(bool disparity) const {
    return {place, MeasurePoint(camera, pose, place, disparity, 1), covariance};
  }
};

TEST(UncertainPoint, HasNoTermWithoutCovarianceOrBehindTheCamera) {
  const Measured m;
  const auto match = m.Match(true);
  const auto term = [&](const Eigen::Vector3d& place, const Eigen::Matrix3d& covariance) {
    return MakeUncertainPointTerm(m.camera, m.pose, place, covariance, match.measurement);
  };
  EXPECT_TRUE(term(m.place, m.covariance));
  EXPECT_FALSE(term(m.place, Eigen::Matrix3d::Zero()));
  EXPECT_FALSE(term(Inverse(m.pose) * Eigen::Vector3d(0, 0, -1), m.covariance));
}

// Hardly in front of the camera, with a covariance along the ray alone: S is nearly singular. There
// is a finite term or none, and no such match is taken for exact.
TEST(UncertainPoint, IsFiniteOrNothingRightBeforeTheCamera) {
  const Measured m;
  auto match = m.Match(true);
  for (const double z : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    const Eigen::Vector3d ray = Eigen::Vector3d(0.3, -0.2, 1) * z;
    const Eigen::Vector3d in_world = Inverse(m.pose).rotation * ray;
    match.point_in_world = Inverse(m.pose) * ray;
    match.point_covariance = 1 / (z * z) * in_world * in_world.transpose();
    const auto term = MakeUncertainPointTerm(
        m.camera, m.pose, match.point_in_world, match.point_covariance, match.measurement);
    EXPECT_EQ(term.has_value(), EvaluateMatch(m.camera, m.pose, match).has_value()) << z;
    EXPECT_TRUE(!term || term->whitening.allFinite()) << z;
  }
}

TEST(UncertainPoint, WithoutCovarianceAMatchIsAMeasurement) {
  const Measured m;
  auto match = m.Match(true);
  match.point_covariance.setZero();
  match.measurement.px += Eigen::Vector2d(2, -1);
  const auto a = EvaluateMatch(m.camera, m.pose, match);
  const auto b = EvaluatePoint(m.camera, m.pose, m.place, match.measurement);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->r, b->r);
  EXPECT_EQ(a->J_pose, b->J_pose);
}

// The point is elsewhere than said and the image is noisy: the whitened residual has unit variance
// in each of its rows, and they are independent.
TEST(UncertainPoint, WhitensWhatNoiseAndPlaceDoTogether) {
  const Measured m;
  for (const bool disparity : {true, false}) {
    Random random(5);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    constexpr int kSamples = 20000;
    constexpr double kSmall = 0.1;  // of the deviations, where projection is linear
    for (int i = 0; i < kSamples; ++i) {
      const Eigen::Vector3d truth = m.place + kSmall * m.root * random.NormalVector(1);
      auto measurement = MeasurePoint(m.camera, m.pose, truth, disparity, kSmall);
      AddNoise(random, kSmall, measurement);
      const auto r =
          EvaluateMatch(m.camera, m.pose, {m.place, measurement, kSmall * kSmall * m.covariance});
      ASSERT_TRUE(r);
      ASSERT_EQ(r->rows, disparity ? 3 : 2);
      sum += r->r * r->r.transpose();
    }
    Eigen::Matrix3d expected = Eigen::Matrix3d::Identity();
    if (!disparity) expected(2, 2) = 0;
    EXPECT_LT((sum / kSamples - expected).norm(), 0.05) << sum / kSamples;
  }
}

TEST(UncertainPoint, DerivativesAreThoseOfTheWhitenedResidual) {
  const Measured m;
  const auto match = m.Match(true);
  const auto at = EvaluateMatch(m.camera, m.pose, match);
  const auto exact = EvaluatePoint(m.camera, m.pose, m.place, match.measurement);
  const auto term =
      MakeUncertainPointTerm(m.camera, m.pose, m.place, match.point_covariance, match.measurement);
  ASSERT_TRUE(at && exact && term);  // with deviations of one, the exact one is in pixels
  const auto whitened = [&](const Vector6d& step) -> Eigen::Vector3d {
    const Rigid3 moved = RetractLeft(m.pose, step);
    return term->whitening * EvaluatePoint(m.camera, moved, m.place, match.measurement)->r;
  };
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = 1e-6 * Vector6d::Unit(i);
    const Eigen::Vector3d slope = (whitened(step) - whitened(-step)) / 2e-6;
    EXPECT_LT((at->J_pose.col(i) - slope).norm(), 1e-5 * at->J_pose.norm()) << i;
  }
  // Less is known than of an exact point, in every direction.
  const Matrix6d less = exact->J_pose.transpose() * exact->J_pose -
                        at->J_pose.transpose() * at->J_pose + 1e-9 * Matrix6d::Identity();
  EXPECT_EQ(Eigen::LLT<Matrix6d>(less).info(), Eigen::Success);
}

}  // namespace

}  // namespace plumbline
