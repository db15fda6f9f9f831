// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/uncertain_point.h"

#include "tests/optimization/random_scene.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
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
