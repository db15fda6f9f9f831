// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/rotation_fit.h"

#include "plumbline/geometry/se3.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const Eigen::Matrix3d kTurn = ExpSo3(Eigen::Vector3d(0.4, -1.1, 2.0)).toRotationMatrix();

Eigen::Matrix3d CorrelationOf(const Eigen::Matrix3d& sources, const Eigen::Matrix3d& turn) {
  return turn * sources * sources.transpose();
}

TEST(FitRotation, FindsTheRotationOfVectors) {
  const Eigen::Matrix3d sources{{1, 0.2, 0}, {0, 2, 0.1}, {0.3, 0, 0.5}};
  const RotationFit fit = FitRotation(CorrelationOf(sources, kTurn));
  EXPECT_LT((fit.rotation - kTurn).norm(), 1e-12);
  EXPECT_GT(fit.singular_values(2), 0);
}

TEST(FitRotation, FindsItFromVectorsInAPlane) {
  const Eigen::Matrix3d sources{{1, 0.2, 0}, {0, 2, 0}, {0, 0, 0}};
  const RotationFit fit = FitRotation(CorrelationOf(sources, kTurn));
  EXPECT_LT((fit.rotation - kTurn).norm(), 1e-12);
  EXPECT_NEAR(fit.singular_values(2), 0, 1e-12);
  EXPECT_GT(fit.singular_values(1), 0.1);
}

TEST(FitRotation, GivesNoReflectionForMirroredVectors) {
  const Eigen::Vector3d kMirror(1, 1, -1);
  const Eigen::Matrix3d mirrored = kTurn * kMirror.asDiagonal();
  const Eigen::Matrix3d sources{{3, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  const RotationFit fit = FitRotation(CorrelationOf(sources, mirrored));
  EXPECT_NEAR(fit.rotation.determinant(), 1, 1e-12);
  EXPECT_NEAR(fit.singular_values(2), -1, 1e-12);
  // No rotation fits all three mirrored vectors. The best one fits the two longest of them.
  EXPECT_LT((fit.rotation - kTurn).norm(), 1e-12);
}

}  // namespace
}  // namespace plumbline
