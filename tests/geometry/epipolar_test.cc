// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/epipolar.h"

#include "tests/support/random_geometry.h"

#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

Rigid3 SmallMotion() { return {ExpSo3({0.02, -0.05, 0.03}), {0.3, 0.1, 0.05}}; }

Eigen::Vector3d PointInView(Rng& rng) {
  const double z = rng.Uniform(2, 6);
  return {rng.Uniform(-0.5, 0.5) * z, rng.Uniform(-0.4, 0.4) * z, z};
}

TEST(EssentialMatrix, HoldsTheRaysOfAPointTogether) {
  Rng rng(1);
  for (int i = 0; i < 30; ++i) {
    const Rigid3 motion = RandomRigid(rng);
    const Eigen::Vector3d p = RandomVector<3>(rng);
    EXPECT_NEAR((motion * p).dot(EssentialMatrix(motion) * p), 0, 1e-13);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(EssentialMatrix(motion));
    EXPECT_NEAR(svd.singularValues()(0), svd.singularValues()(1), 1e-13);
    EXPECT_NEAR(svd.singularValues()(2), 0, 1e-13);
  }
}

TEST(FundamentalMatrix, HoldsTheirPixelsTogether) {
  const RectifiedCamera camera = TestCamera();
  const Eigen::Matrix3d F = FundamentalMatrix(camera, SmallMotion());
  Rng rng(2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d p = PointInView(rng);
    const Eigen::Vector2d a = camera.Project(p);
    const Eigen::Vector2d b = camera.Project(SmallMotion() * p);
    const Eigen::Vector3d line_in_b = F * a.homogeneous();
    EXPECT_NEAR(b.homogeneous().dot(line_in_b) / line_in_b.head<2>().norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace plumbline
