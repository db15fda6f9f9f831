// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/orientation.h"

#include "plumbline/base/error.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kWidth = 640, kHeight = 400;

Camera Distorted(DistortionModel model) {
  return Camera({.fx = 500,
                 .fy = 510,
                 .cx = 300,
                 .cy = 220,
                 .width = kWidth,
                 .height = kHeight,
                 .model = model,
                 .distortion = {-0.2, 0.05, 0.003, -0.002, 0.001}});
}

// Where EXIF says that a pixel of the stored image is shown.
Eigen::Vector2d Shown(int exif, const Eigen::Vector2d& stored) {
  const double x = stored.x(), y = stored.y();
  const double right = kWidth - 1, bottom = kHeight - 1;
  switch (exif) {
    case 2:
      return {right - x, y};
    case 3:
      return {right - x, bottom - y};
    case 4:
      return {x, bottom - y};
    case 5:
      return {y, x};
    case 6:
      return {bottom - y, x};
    case 7:
      return {bottom - y, right - x};
    case 8:
      return {y, right - x};
    default:
      return stored;
  }
}

TEST(Orientation, TurnsPixelsAndCamerasAlike) {
  for (const DistortionModel model :
       {DistortionModel::kNone, DistortionModel::kRadTan, DistortionModel::kEquidistant}) {
    const Camera stored = Distorted(model);
    for (int exif = 1; exif <= 8; ++exif) {
      const Orientation orientation = OrientationOfExif(exif);
      const Camera turned = Turned(stored, orientation);
      EXPECT_EQ(turned.width(), exif >= 5 ? kHeight : kWidth);
      for (const Eigen::Vector2d& px : {Eigen::Vector2d(20, 30), Eigen::Vector2d(500, 350)}) {
        const Eigen::Vector3d ray = *stored.Unproject(px);
        // The ray to the pixel where this one is shown, by the mirror images of the axes alone.
        Eigen::Vector3d shown = ray;
        if (orientation.transpose) std::swap(shown.x(), shown.y());
        if (orientation.flip_x) shown.x() = -shown.x();
        if (orientation.flip_y) shown.y() = -shown.y();
        const auto projected = turned.Project(shown);
        ASSERT_TRUE(projected);
        EXPECT_LT((*projected - Shown(exif, px)).norm(), 1e-6) << exif;
        if (orientation.Mirrors()) continue;
        EXPECT_LT((TurnedFromStored(orientation) * ray - shown).norm(), 1e-12) << exif;
      }
      EXPECT_EQ(Turned(turned, Inverse(orientation)).intrinsics().width, kWidth);
      const CameraIntrinsics back = Turned(turned, Inverse(orientation)).intrinsics();
      EXPECT_NEAR(back.cx, stored.intrinsics().cx, 1e-9);
      EXPECT_NEAR(back.cy, stored.intrinsics().cy, 1e-9);
      EXPECT_EQ(back.distortion, stored.intrinsics().distortion);
    }
  }
}

TEST(Orientation, IsToldInWords) {
  const std::vector<std::string> words = {"as stored",
                                          "mirrored",
                                          "turned by 180 degrees clockwise",
                                          "turned by 180 degrees clockwise and mirrored",
                                          "turned by 90 degrees clockwise and mirrored",
                                          "turned by 90 degrees clockwise",
                                          "turned by 270 degrees clockwise and mirrored",
                                          "turned by 270 degrees clockwise"};
  for (int exif = 1; exif <= 8; ++exif) {
    EXPECT_EQ(Describe(OrientationOfExif(exif)), words[static_cast<std::size_t>(exif) - 1]);
  }
  EXPECT_TRUE(OrientationOfExif(0).IsIdentity());
  EXPECT_TRUE(OrientationOfExif(9).IsIdentity());
}

TEST(Orientation, KeepsTheBodyWhereItIs) {
  Calibration stored;
  stored.left = Distorted(DistortionModel::kRadTan);
  stored.body_from_left = Rigid3{ExpSo3({0.1, -0.4, 0.3}), {0.2, 0.1, -0.3}};
  const Orientation quarter = ClockwiseTurn(90);
  const Calibration turned = Turned(stored, quarter);
  const Eigen::Vector3d point(0.3, -0.2, 2);  // in the frame of the stored image
  const Eigen::Vector3d same = TurnedFromStored(quarter) * point;
  EXPECT_LT((*turned.body_from_left * same - *stored.body_from_left * point).norm(), 1e-12);
  EXPECT_EQ(Turned(stored, OrientationOfExif(2)).body_from_left->translation,
            stored.body_from_left->translation);
  stored.right = stored.left;
  EXPECT_THROW(Turned(stored, quarter), BugError);
}

}  // namespace
}  // namespace plumbline
