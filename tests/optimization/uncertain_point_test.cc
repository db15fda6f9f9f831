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
  EXPECT_LT((at->J_pose - term->whitening * exact->J_pose).norm(), 1e-9);
  EXPECT_LT((at->J_point - term->whitening * exact->J_point).norm(), 1e-9);
  // Less is known than of an exact point, in every direction.
  const Matrix6d less = exact->J_pose.transpose() * exact->J_pose -
                        at->J_pose.transpose() * at->J_pose + 1e-9 * Matrix6d::Identity();
  EXPECT_EQ(Eigen::LLT<Matrix6d>(less).info(), Eigen::Success);
}

}  // namespace
}  // namespace plumbline
