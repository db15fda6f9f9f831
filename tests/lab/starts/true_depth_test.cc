// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/true_depth.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kWidth = 320, kHeight = 240;
const RectifiedCamera kCamera{250, 250, 160, 120, 0, kWidth, kHeight};

Camera RawCamera(double k1) {
  return Camera({.fx = 260,
                 .fy = 255,
                 .cx = 158,
                 .cy = 121,
                 .width = kWidth,
                 .height = kHeight,
                 .model = DistortionModel::kRadTan,
                 .distortion = {k1, 0, 0, 0, 0}});
}

// What a depth camera sees of the plane n . p = 1.
DepthImage DepthOfPlane(const Camera& raw, const Vector3d& n) {
  DepthImage depth(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      depth.at(x, y) = static_cast<float>(1 / n.dot(*raw.Unproject({x, y})));
    }
  }
  return depth;
}

TEST(TrueDepth, ADepthImageIsReadThroughTheLensAndTheTurnOfTheCamera) {
  const Camera raw = RawCamera(-0.2);
  const Quaterniond rectified_from_raw(Eigen::AngleAxisd(0.05, Vector3d(1, 2, 3).normalized()));
  const Vector3d n(0.05, -0.03, 0.5);
  const TrueDepthOfImage depth(DepthOfPlane(raw, n), raw, kCamera, rectified_from_raw);
  const Vector3d turned = rectified_from_raw * n;
  for (const Vector2d& px : {Vector2d(160, 120), Vector2d(60, 80), Vector2d(250.4, 170.7)}) {
    const Vector3d ray = kCamera.Unproject(px);
    const auto point = depth.PointAt(px);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->cross(ray).norm(), 0, 1e-6) << "on the ray through the pixel";
    EXPECT_NEAR(point->z() * turned.dot(ray), 1, 2e-3) << "within the slope of half a pixel";
  }
  EXPECT_GT(depth.Samples().size(), 100U);
}

TEST(TrueDepth, ADepthImageKnowsNothingAtEdgesAndHoles) {
  DepthImage image(kWidth, kHeight, 2.0F);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 100; x < kWidth; ++x) image.at(x, y) = 3.0F;
  }
  image.at(50, 50) = 0;
  const RectifiedCamera same{260, 255, 158, 121, 0, kWidth, kHeight};
  const TrueDepthOfImage depth(image, RawCamera(0), same, Quaterniond::Identity());
  EXPECT_NEAR(depth.PointAt({90, 100})->z(), 2, 1e-6);
  EXPECT_NEAR(depth.PointAt({110, 100})->z(), 3, 1e-6);
  EXPECT_FALSE(depth.PointAt({99, 100})) << "an edge";
  EXPECT_FALSE(depth.PointAt({51, 50})) << "a hole beside it";
  EXPECT_FALSE(depth.PointAt({0, 100})) << "the border";
  EXPECT_FALSE(depth.PointAt({-40, 100})) << "outside";
}

TEST(TrueDepth, PointsAnswerNearTheirPixelsIfAccurate) {
  const TrueDepthOfPoints depth(
      {{2 * kCamera.Unproject({100, 100}), true}, {3 * kCamera.Unproject({200, 100}), false}},
      kCamera);
  EXPECT_NEAR(depth.PointAt({101, 101})->z(), 2, 1e-9);
  EXPECT_FALSE(depth.PointAt({102, 101}));
  EXPECT_FALSE(depth.PointAt({200, 100}));
  EXPECT_EQ(depth.Samples().size(), 2U) << "those for parallax alone too";
}

TEST(TrueDepth, StereoGivesThePointsOfItsDisparities) {
  RectifiedCamera pair = kCamera;
  pair.baseline = 0.1;
  const Quaterniond turn(Eigen::AngleAxisd(0.03, Vector3d::UnitY()));
  Features features;
  const auto add = [&features](const Vector2d& px, std::optional<Disparity> disparity) {
    PointFeature point;
    point.px = px;
    features.points.push_back(point);
    features.point_disparity.push_back(disparity);
  };
  add({120, 90}, Disparity{10, 0.3});
  add({180, 90}, Disparity{4, 0.3});
  add({200, 90}, std::nullopt);
  const TrueDepthOfPoints depth = TrueDepthOfStereo(features, pair, turn, kCamera);
  ASSERT_EQ(depth.Samples().size(), 2U);
  const Vector3d near = turn * Vector3d(2.5 * kCamera.Unproject({120, 90}));
  EXPECT_NEAR((*depth.PointAt(kCamera.Project(near)) - near).norm(), 0, 1e-9);
  EXPECT_FALSE(depth.PointAt(kCamera.Project(depth.Samples()[1]))) << "known to 7 % only";
}

}  // namespace
}  // namespace plumbline
