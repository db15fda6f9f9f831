// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/camera.h"

#include "plumbline/base/error.h"

#include "tests/support/euroc_calibration.h"
#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

CameraIntrinsics Pinhole() {
  return {.fx = 500, .fy = 480, .cx = 320, .cy = 240, .width = 640, .height = 480};
}

CameraIntrinsics TumFr1() {
  return {.fx = 517.306408,
          .fy = 516.469215,
          .cx = 318.643040,
          .cy = 255.313989,
          .width = 640,
          .height = 480,
          .model = DistortionModel::kRadTan,
          .distortion = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
}

CameraIntrinsics Fisheye() {
  return {.fx = 190.98,
          .fy = 190.97,
          .cx = 254.93,
          .cy = 256.90,
          .width = 512,
          .height = 512,
          .model = DistortionModel::kEquidistant,
          .distortion = {0.0034823894, 0.0007150348, -0.0020532361, 0.00020293673}};
}

std::vector<CameraIntrinsics> AllModels() {
  return {Pinhole(), TumFr1(), EurocCalibration().left.intrinsics(), Fisheye()};
}

TEST(Camera, IdealProjectionIsThePinhole) {
  const Camera camera(Pinhole());
  EXPECT_LT((*camera.Project({0.2, -0.1, 2}) - Eigen::Vector2d(370, 216)).norm(), 1e-12);
  EXPECT_LT((*camera.Unproject({370, 216}) - Eigen::Vector3d(0.1, -0.05, 1)).norm(), 1e-15);
}

TEST(Camera, RadialTangentialMatchesTheFormulaByHand) {
  CameraIntrinsics in = Pinhole();
  in.model = DistortionModel::kRadTan;
  in.distortion = {0.1, 0.01, 0.002, 0.003, 0.0005};
  // x = 0.3, y = 0.4, r^2 = 0.25: radial 1.0256328125; x: + 2 p1 xy + p2 (r^2 + 2 x^2), y likewise.
  const double radial = 1 + 0.1 * 0.25 + 0.01 * 0.0625 + 0.0005 * 0.015625;
  const double x = 0.3 * radial + 2 * 0.002 * 0.12 + 0.003 * (0.25 + 0.18);
  const double y = 0.4 * radial + 0.002 * (0.25 + 0.32) + 2 * 0.003 * 0.12;
  const auto px = Camera(in).Project({0.6, 0.8, 2});
  ASSERT_TRUE(px);
  EXPECT_NEAR(px->x(), 500 * x + 320, 1e-10);
  EXPECT_NEAR(px->y(), 480 * y + 240, 1e-10);
}

TEST(Camera, EquidistantMatchesTheFormulaByHand) {
  CameraIntrinsics in = Pinhole();
  in.model = DistortionModel::kEquidistant;
  in.distortion = {0.01, -0.002, 0.0003, -0.00004, 0};
  const double theta = std::atan2(1.0, 2.0);
  const double t2 = theta * theta;
  const double bent = theta * (1 + 0.01 * t2 - 0.002 * t2 * t2 + 0.0003 * t2 * t2 * t2 -
                               0.00004 * t2 * t2 * t2 * t2);
  const auto px = Camera(in).Project({0.6, 0.8, 2});
  ASSERT_TRUE(px);
  EXPECT_NEAR(px->x(), 500 * 0.6 * bent + 320, 1e-10);
  EXPECT_NEAR(px->y(), 480 * 0.8 * bent + 240, 1e-10);
}

TEST(Camera, UnprojectInvertsProjectOverTheWholeImage) {
  for (const CameraIntrinsics& in : AllModels()) {
    const Camera camera(in);
    for (int v = 0; v < in.height; v += 13) {
      for (int u = 0; u < in.width; u += 13) {
        const Eigen::Vector2d px(u, v);
        // The corners of the fisheye image look backwards.
        const double angle = (px - Eigen::Vector2d(in.cx, in.cy)).norm() / in.fx;
        if (in.model == DistortionModel::kEquidistant && angle > 1.5) continue;
        const auto ray = camera.Unproject(px);
        ASSERT_TRUE(ray) << u << " " << v;
        ASSERT_EQ(ray->z(), 1);
        const auto back = camera.Project(3 * *ray);
        ASSERT_TRUE(back);
        EXPECT_LT((*back - px).norm(), 1e-9) << u << " " << v;
      }
    }
  }
}

TEST(Camera, JacobianIsTheDerivativeOfProject) {
  Rng rng(1);
  for (const CameraIntrinsics& in : AllModels()) {
    const Camera camera(in);
    for (int i = 0; i < 50; ++i) {
      // The first points lie on and next to the optical axis.
      const double spread = i == 0 ? 0 : (i < 5 ? 1e-6 : 0.4);
      const double z = rng.Uniform(0.5, 5);
      const Eigen::Vector3d p(rng.Normal(spread) * z, rng.Normal(spread) * z, z);
      Camera::ProjectionJacobian J;
      if (!camera.Project(p, &J)) continue;
      const Camera::ProjectionJacobian numeric = NumericJacobian(
          [&](const Eigen::Vector3d& q) { return camera.Project(q).value(); }, p, 1e-4 * z);
      EXPECT_LT((J - numeric).norm(), 1e-7 * in.fx) << p.transpose();
    }
  }
}

TEST(Camera, SeesNothingBehindIt) {
  for (const CameraIntrinsics& in : AllModels()) {
    EXPECT_FALSE(Camera(in).Project({0.1, 0.1, 0}));
    EXPECT_FALSE(Camera(in).Project({0.1, 0.1, -1}));
  }
}

TEST(Camera, StopsWhereTheDistortionTurnsBack) {
  // r (1 - 0.3 r^2) rises up to r = 1 / sqrt(0.9) = 1.054 and reaches 0.703 there.
  CameraIntrinsics in = Pinhole();
  in.model = DistortionModel::kRadTan;
  in.distortion = {-0.3, 0, 0, 0, 0};
  const Camera camera(in);
  EXPECT_TRUE(camera.Project({1.05, 0, 1}));
  EXPECT_FALSE(camera.Project({1.06, 0, 1}));
  EXPECT_FALSE(camera.Project({3, 0, 1})) << "it would fold into the image";
  EXPECT_TRUE(camera.Unproject({320 + 500 * 0.70, 240}));
  EXPECT_FALSE(camera.Unproject({320 + 500 * 0.71, 240}));
  EXPECT_FALSE(camera.Unproject({std::numeric_limits<double>::quiet_NaN(), 240}));
}

TEST(Camera, StrongCoefficientsInvertOrRefuse) {
  Rng rng(2);
  int answered = 0;
  for (int i = 0; i < 3000; ++i) {
    CameraIntrinsics in = Pinhole();
    in.model = i % 2 == 0 ? DistortionModel::kRadTan : DistortionModel::kEquidistant;
    for (double& k : in.distortion) k = rng.Normal(0.3);
    if (i % 2 == 0) in.distortion[2] = in.distortion[3] = rng.Normal(0.005);
    const Camera camera(in);
    const Eigen::Vector2d px(rng.Uniform(0, 639), rng.Uniform(0, 479));
    const auto ray = camera.Unproject(px);
    if (!ray) continue;
    ++answered;
    EXPECT_LT((camera.Project(*ray).value() - px).norm(), 1e-7);
  }
  EXPECT_GT(answered, 2000);
}

TEST(Camera, KnowsWhetherItIsIdeal) {
  CameraIntrinsics in = Pinhole();
  EXPECT_TRUE(Camera(in).IsIdeal());
  in.model = DistortionModel::kRadTan;
  EXPECT_TRUE(Camera(in).IsIdeal());
  in.distortion[4] = 1e-9;
  EXPECT_FALSE(Camera(in).IsIdeal());
  in.distortion = {};
  in.model = DistortionModel::kEquidistant;
  EXPECT_FALSE(Camera(in).IsIdeal());
}

TEST(Camera, RefusesImpossibleNumbersByName) {
  const auto message = [](const CameraIntrinsics& in) {
    try {
      const Camera camera(in);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CameraIntrinsics in = Pinhole();
  in.fx = -3;
  EXPECT_EQ(message(in), "camera: expected fx > 0, found -3");
  in = Pinhole();
  in.fy = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message(in), "camera: expected fy > 0, found nan");
  in = Pinhole();
  in.cx = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message(in), "camera: expected a finite cx, found inf");
  in = Pinhole();
  in.height = 0;
  EXPECT_EQ(message(in), "camera: expected height > 0, found 0");
  in = Pinhole();
  in.distortion[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message(in), "camera: expected finite distortion, found nan");
  EXPECT_EQ(message(Pinhole()), "no error");
}

}  // namespace
}  // namespace plumbline
