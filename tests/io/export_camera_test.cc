// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/export_camera.h"

#include "plumbline/image/rectify.h"

#include "tests/support/euroc_calibration.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// The left camera of a pair, whose rectified frame is turned.
TEST(ExportCamera, AsDeliveredShowsWhatTheRectifierTakesFromThere) {
  const Calibration calibration = EurocCalibration();
  const Rectifier rectifier(calibration);
  const Eigen::Quaterniond turn = rectifier.rectified_left_from_left();
  ASSERT_GT(turn.angularDistance(Eigen::Quaterniond::Identity()), 1e-3);
  const ExportCamera delivered(rectifier.camera(), turn, calibration.left);
  EXPECT_TRUE(delivered.IsDelivered());
  EXPECT_EQ(delivered.intrinsics(), calibration.left.intrinsics());
  for (const Eigen::Vector2d& px : {Eigen::Vector2d(40, 30), {700, 21}, {376, 440}}) {
    const auto raw = delivered.PixelOf(px);
    ASSERT_TRUE(raw);
    EXPECT_GT((*raw - px).norm(), 1);
    EXPECT_LT((*rectifier.RectifyLeft(*raw) - px).norm(), 1e-6);
    const Eigen::Vector3d point = 3 * rectifier.camera().Unproject(px);
    EXPECT_LT((*delivered.Project(point) - *raw).norm(), 1e-9);
    const Rigid3 pose{{0.8, 0.6, 0, 0}, {1, 2, 3}};
    EXPECT_LT(
        (calibration.left.Project(delivered.PoseOf(pose) * (Inverse(pose) * point)).value() - *raw)
            .norm(),
        1e-9);
  }
  EXPECT_FALSE(delivered.Project({0, 0, -1}));
}

TEST(ExportCamera, OfTheMapChangesNothing) {
  const RectifiedCamera camera = Rectifier(EurocCalibration()).camera();
  const ExportCamera exported(camera);
  EXPECT_FALSE(exported.IsDelivered());
  EXPECT_EQ(exported.intrinsics().fx, camera.fx);
  EXPECT_EQ(exported.intrinsics().height, camera.height);
  EXPECT_EQ(exported.intrinsics().model, DistortionModel::kNone);
  EXPECT_EQ(exported.PixelOf({7.25, 9}), Eigen::Vector2d(7.25, 9));
  EXPECT_EQ(exported.Project({1, 2, 4}), camera.Project({1, 2, 4}));
  const Rigid3 pose{{0.8, 0.6, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(exported.PoseOf(pose).translation, pose.translation);
}

}  // namespace
}  // namespace plumbline
