// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/pose_with_covariance.h"

#include "tests/support/random_geometry.h"
#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace pose_with_covariance_test {

PoseWithCovariance RandomPose(Rng& rng, double sigma) {
  PoseWithCovariance pose;
  const Rigid3 rigid = RandomRigid(rng);
  pose.pose = {1 + rng.Uniform(-0.3, 0.3), rigid.rotation, rigid.translation};
  Matrix7d A;
  for (int i = 0; i < 7; ++i) A.col(i) = RandomVector<7>(rng, sigma);
  pose.covariance = A * A.transpose();
  return pose;
}

Similarity3 Sample(const PoseWithCovariance& pose, Rng& rng) {
  const Matrix7d L = pose.covariance.llt().matrixL();
  return RetractLeft(pose.pose, L * RandomVector<7>(rng));
}

// The covariance of samples about the composition is the one computed.
TEST(PoseWithCovariance, ComposesAsSamplesDo) {
  Rng rng(3, "uncertain_pose");
  const PoseWithCovariance a = RandomPose(rng, 1e-3);
  const PoseWithCovariance b = RandomPose(rng, 1e-3);
  const PoseWithCovariance both = Compose(a, b);
  double chi2 = 0;
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    const Similarity3 sample = Sample(a, rng) * Sample(b, rng);
    chi2 += ClosingChi2({sample * Inverse(both.pose), both.covariance}) / kSamples;
  }
  EXPECT_NEAR(chi2, 7, 0.4);
}

TEST(PoseWithCovariance, InvertsAsSamplesDo) {
  Rng rng(4, "uncertain_pose");
  const PoseWithCovariance a = RandomPose(rng, 1e-3);
  const PoseWithCovariance inverse = Inverse(a);
  double chi2 = 0;
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    chi2 += ClosingChi2({Inverse(Sample(a, rng)) * Inverse(inverse.pose), inverse.covariance}) /
            kSamples;
  }
  EXPECT_NEAR(chi2, 7, 0.4);
}

TEST(PoseWithCovariance, RigidOnesHaveSixDegreesOfFreedom) {
  PoseWithCovariance pose;
  pose.covariance.diagonal().head<6>().setConstant(0.01);
  pose.pose.translation = {0.1, 0, 0};
  EXPECT_NEAR(ClosingChi2(pose), 1, 1e-9);
  pose.covariance.setZero();
  EXPECT_EQ(ClosingChi2(pose), std::numeric_limits<double>::infinity());
}

}  // namespace pose_with_covariance_test
}  // namespace plumbline
