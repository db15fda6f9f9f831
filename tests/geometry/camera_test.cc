// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/camera.h"

#include "plumbline/base/error.h"

#include "tests/support/euroc_calibration.h"
#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
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

// A camera of 640x480 pixels whose numbers are of the size of real lenses.
CameraIntrinsics Lens(DistortionModel model,
                      double focal,
                      const std::array<double, kMostCoefficients>& distortion) {
  return {.fx = focal,
          .fy = 1.01 * focal,
          .cx = 318.3,
          .cy = 241.7,
          .width = 640,
          .height = 480,
          .model = model,
          .distortion = distortion};
}

std::vector<CameraIntrinsics> AllModels() {
  using enum DistortionModel;
  return {Pinhole(),
          TumFr1(),
          EurocCalibration().left.intrinsics(),
          Fisheye(),
          // Depth cameras: poles and zeros of the quotient nearly cancel.
          Lens(kRational, 505, {0.42, -2.51, 0.0008, -0.0004, 1.47, 0.3, -2.33, 1.4}),
          Lens(kRational, 300, {8.5, 4.2, 0.0002, -0.0001, 0.21, 8.85, 7.06, 1.1}),
          Lens(kFov, 350, {0.93}),
          Lens(kDoubleSphere, 220, {-0.18, 0.59}),
          Lens(kDoubleSphere, 200, {0.1, 0.4}),
          Lens(kEucm, 230, {0.63, 1.04}),
          Lens(kEucm, 260, {0.45, 0.9}),
          Lens(kOmni, 420, {0.9, -0.2, 0.05, 0.001, -0.0005}),
          Lens(kOmni, 700, {1.9, -0.03, 0.01, 0.0002, 0.0001})};
}

// True if a model has no rays at 90 degrees off the axis and beyond.
bool EndsAtThePlane(DistortionModel model) {
  using enum DistortionModel;
  return model == kNone || model == kRadTan || model == kRational || model == kFov;
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
        const auto ray = camera.Ray(px);
        ASSERT_TRUE(ray) << FormOf(in.model).name << " " << u << " " << v;
        const auto back = camera.Project(3 * *ray);
        ASSERT_TRUE(back) << FormOf(in.model).name << " " << u << " " << v;
        EXPECT_LT((*back - px).norm(), 1e-9) << FormOf(in.model).name << " " << u << " " << v;
        const auto at_one = camera.Unproject(px);
        ASSERT_EQ(at_one.has_value(), ray->z() > 1e-9 * ray->norm());
        if (!at_one) continue;
        EXPECT_EQ(at_one->z(), 1);
        EXPECT_LT(at_one->cross(*ray).norm(), 1e-12 * at_one->norm() * ray->norm());
      }
    }
  }
}

// The formulas of the papers, written down once more.
TEST(Camera, WideModelsMatchTheirFormulasByHand) {
  using enum DistortionModel;
  const Eigen::Vector3d p(0.6, -0.3, 0.2);
  const double r2 = 0.45, n = std::sqrt(0.45 + 0.04);
  const auto expect = [&](const CameraIntrinsics& in, double x, double y) {
    const auto px = Camera(in).Project(p);
    ASSERT_TRUE(px) << FormOf(in.model).name;
    EXPECT_NEAR(px->x(), in.fx * x + in.cx, 1e-10) << FormOf(in.model).name;
    EXPECT_NEAR(px->y(), in.fy * y + in.cy, 1e-10) << FormOf(in.model).name;
  };
  const double shifted = -0.2 * n + 0.2;
  double below = 0.6 * std::sqrt(r2 + shifted * shifted) + 0.4 * shifted;
  expect(Lens(kDoubleSphere, 160, {-0.2, 0.6}), 0.6 / below, -0.3 / below);
  below = 0.6 * std::sqrt(1.1 * r2 + 0.04) + 0.4 * 0.2;
  expect(Lens(kEucm, 160, {0.6, 1.1}), 0.6 / below, -0.3 / below);
  const double x = 0.6 / (0.2 + 1.2 * n), y = -0.3 / (0.2 + 1.2 * n), s2 = x * x + y * y;
  const double radial = 1 - 0.1 * s2 + 0.02 * s2 * s2;
  expect(Lens(kOmni, 160, {1.2, -0.1, 0.02, 0.003, 0.004}),
         x * radial + 2 * 0.003 * x * y + 0.004 * (s2 + 2 * x * x),
         y * radial + 0.003 * (s2 + 2 * y * y) + 2 * 0.004 * x * y);
  const double r = std::sqrt(r2) / 0.2, bent = std::atan(2 * r * std::tan(0.45)) / 0.9;
  expect(Lens(kFov, 160, {0.9}), 3 * bent / r, -1.5 * bent / r);
}

TEST(Camera, RationalMatchesTheFormulaByHand) {
  const CameraIntrinsics in =
      Lens(DistortionModel::kRational, 500, {0.4, -0.2, 0.002, 0.003, 0.1, 0.3, -0.1, 0.05});
  const double u = 0.25, x = 0.3, y = 0.4;
  const double radial = (1 + 0.4 * u - 0.2 * u * u + 0.1 * u * u * u) /
                        (1 + 0.3 * u - 0.1 * u * u + 0.05 * u * u * u);
  const auto px = Camera(in).Project({0.6, 0.8, 2});
  ASSERT_TRUE(px);
  EXPECT_NEAR(px->x(), 500 * (x * radial + 2 * 0.002 * 0.12 + 0.003 * 0.43) + in.cx, 1e-10);
  EXPECT_NEAR(px->y(), 505 * (y * radial + 0.002 * 0.57 + 2 * 0.003 * 0.12) + in.cy, 1e-10);
}

// The denominator's zero, where the radius has no limit, is known to rounding alone.
TEST(Camera, ARationalLensHasRaysUpToItsPoleWhateverTheLastDigit) {
  for (const double last : {-14.2, -14.24, -14.25, -14.2606, -14.2607, -14.2608}) {
    const Camera camera(
        Lens(DistortionModel::kRational,
             600,
             {-4.7337, 16.2768, -0.00082, 0.00003, -14.0361, -4.7894, 16.5058, last}));
    EXPECT_TRUE(camera.Ray({0, 0})) << last;
    EXPECT_TRUE(camera.Ray({320, 240})) << last;
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

TEST(Camera, JacobianIsTheDerivativeInEveryDirectionOfTheImage) {
  for (const CameraIntrinsics& in : AllModels()) {
    const Camera camera(in);
    for (int v = 3; v < in.height; v += 67) {
      for (int u = 2; u < in.width; u += 71) {
        const Eigen::Vector3d p = 2 * camera.Ray({u, v})->normalized();
        Camera::ProjectionJacobian J;
        ASSERT_TRUE(camera.Project(p, &J));
        const Camera::ProjectionJacobian numeric = NumericJacobian(
            [&](const Eigen::Vector3d& q) { return camera.Project(q).value(); }, p, 1e-5);
        EXPECT_LT((J - numeric).norm(), 1e-5 * (in.fx + J.norm())) << FormOf(in.model).name;
      }
    }
  }
}

TEST(Camera, EndsAtTheAngleThatItTells) {
  constexpr double kDegree = std::numbers::pi / 180;
  for (const CameraIntrinsics& in : AllModels()) {
    const Camera camera(in);
    const double end = camera.MaxAngle();
    const auto at = [&](double angle) {
      return camera.Project({std::sin(angle) * 0.6, std::sin(angle) * 0.8, std::cos(angle)});
    };
    EXPECT_TRUE(at(end - 0.5 * kDegree)) << FormOf(in.model).name;
    const bool beyond = end < std::numbers::pi && at(end + 1e-6);
    EXPECT_FALSE(beyond) << FormOf(in.model).name;
    EXPECT_EQ(end <= std::numbers::pi / 2, EndsAtThePlane(in.model)) << FormOf(in.model).name;
    // Before its end the distance from the centre of the image only grows.
    double last = 0;
    for (double angle = kDegree; angle < end - 0.1 * kDegree; angle += kDegree) {
      const Eigen::Vector2d off = *at(angle) - Eigen::Vector2d(in.cx, in.cy);
      EXPECT_GT(off.norm(), last) << FormOf(in.model).name << " " << angle / kDegree;
      last = off.norm();
    }
  }
  // (x, y) / (z + n) shows all but the direction backwards; z + 2 n ends where z = -n / 2.
  EXPECT_NEAR(Camera(Lens(DistortionModel::kOmni, 200, {1})).MaxAngle(), 180 * kDegree, 1e-7);
  EXPECT_NEAR(Camera(Lens(DistortionModel::kOmni, 200, {2})).MaxAngle(), 120 * kDegree, 1e-12);
  EXPECT_NEAR(Camera(Lens(DistortionModel::kEucm, 200, {0.5, 1})).MaxAngle(), 180 * kDegree, 1e-7);
  EXPECT_NEAR(Camera(Pinhole()).MaxAngle(), 90 * kDegree, 1e-12);
}

TEST(Camera, SeesNothingBehindIt) {
  for (const CameraIntrinsics& in : AllModels()) {
    EXPECT_FALSE(Camera(in).Project({0, 0, -1})) << FormOf(in.model).name;
    EXPECT_FALSE(Camera(in).Project({0, 0, 0}));
    const bool beside = Camera(in).Project({0.1, 0.1, 0}).has_value();
    EXPECT_EQ(beside, !EndsAtThePlane(in.model)) << FormOf(in.model).name;
  }
}

TEST(Camera, TellsTheResolutionOfTheMiddle) {
  EXPECT_NEAR(Camera(Pinhole()).CentreFocal(), 490, 1e-9);
  // n = z on the axis: 1 + xi divides.
  const Camera sphere(Lens(DistortionModel::kDoubleSphere, 200, {0.25, 0.6}));
  EXPECT_NEAR(sphere.CentreFocal(), 201 / 1.25, 1e-9);
  EXPECT_NEAR(Camera(Lens(DistortionModel::kOmni, 500, {1.5})).CentreFocal(), 201, 1e-9);
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
    in.model = i % 3 == 0   ? DistortionModel::kRadTan
               : i % 3 == 1 ? DistortionModel::kEquidistant
                            : DistortionModel::kRational;
    for (double& k : in.distortion) k = rng.Normal(0.3);
    if (i % 3 != 1) in.distortion[2] = in.distortion[3] = rng.Normal(0.005);
    const Camera camera(in);
    const Eigen::Vector2d px(rng.Uniform(0, 639), rng.Uniform(0, 479));
    const auto ray = camera.Ray(px);
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
  using enum DistortionModel;
  EXPECT_EQ(message(Lens(kDoubleSphere, 200, {0.1, 1.2})),
            "camera: double_sphere: expected alpha from 0 to 1, found 1.2");
  EXPECT_EQ(message(Lens(kDoubleSphere, 200, {-1, 0.5})),
            "camera: double_sphere: expected xi above -1, at most 1, found -1");
  EXPECT_EQ(message(Lens(kEucm, 200, {0.5, 0})), "camera: eucm: expected beta above 0, found 0");
  EXPECT_EQ(message(Lens(kOmni, 200, {-0.5})),
            "camera: omni: expected xi from 0 to 1000, found -0.5");
  EXPECT_EQ(message(Lens(kFov, 200, {0})), "camera: fov: expected w between 0 and pi, found 0");
  EXPECT_EQ(message(Pinhole()), "no error");
}

}  // namespace
}  // namespace plumbline
