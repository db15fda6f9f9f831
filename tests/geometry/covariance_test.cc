// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/covariance.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(LargestSigma, IsThatOfTheLongestAxisHoweverTheEllipsoidIsTurned) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d variances(0.04, 9, 1e-6);
  EXPECT_NEAR(LargestSigma(R * variances.asDiagonal() * R.transpose()), 3, 1e-12);
}

TEST(LargestSigma, IsZeroWhereNothingIsUncertain) {
  EXPECT_EQ(LargestSigma(Eigen::Matrix3d::Zero()), 0);
}

TEST(LargestSigma, IsInfiniteWhereACovarianceIsNotKnown) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  covariance(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(LargestSigma(covariance)));
  covariance(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isinf(LargestSigma(covariance)));
}

}  // namespace
}  // namespace plumbline
