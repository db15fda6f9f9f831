// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/cutting_problem.h"

#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(EndpointCovariance, IsThatOfColumnRowAndInverseDepth) {
  const RectifiedCamera camera = TestCamera();
  const Vector3d point(0.7, -0.4, 3);
  const Vector3d measured(camera.Project(point).x(), camera.Project(point).y(), 1 / point.z());
  const auto back = [&](const Vector3d& m) {
    return Vector3d(camera.Unproject(m.head<2>()) / m.z());
  };
  const Matrix3d J = NumericJacobian(back, measured, 1e-4);
  const Matrix3d expected =
      J * Vector3d(1.5 * 1.5, 1.5 * 1.5, 0.02 * 0.02).asDiagonal() * J.transpose();
  const Matrix3d found = CovarianceFromInverseDepth(camera, point, 1.5, 0.02);
  EXPECT_LT((found - expected).norm(), 1e-8 * expected.norm());
}

TEST(EndpointCovariance, OfDisparityIsThatOfColumnRowAndDisparity) {
  const RectifiedCamera camera = TestCamera();
  const Vector3d point(-1.2, 0.3, 5);
  const Vector3d measured(
      camera.Project(point).x(), camera.Project(point).y(), camera.DisparityFromDepth(point.z()));
  const auto back = [&](const Vector3d& m) {
    return Vector3d(camera.Unproject(m.head<2>()) * camera.DepthFromDisparity(m.z()));
  };
  const Matrix3d J = NumericJacobian(back, measured, 1e-3);
  const Matrix3d expected = J * Vector3d(1, 1, 0.25).asDiagonal() * J.transpose();
  const Matrix3d found = CovarianceFromDisparity(camera, point, 1, 0.5);
  EXPECT_LT((found - expected).norm(), 1e-7 * expected.norm());
}

TEST(EndpointCovariance, RefusesPointsBehindTheCamera) {
  EXPECT_THROW(CovarianceFromInverseDepth(TestCamera(), {0, 0, -1}, 1, 1), BugError);
  RectifiedCamera mono = TestCamera();
  mono.baseline = 0;
  EXPECT_THROW(CovarianceFromDisparity(mono, {0, 0, 1}, 1, 1), BugError);
}

}  // namespace
}  // namespace plumbline
