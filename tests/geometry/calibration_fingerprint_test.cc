// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/calibration_fingerprint.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Calibration StereoCalibration() {
  CameraIntrinsics intrinsics;
  intrinsics.fx = intrinsics.fy = 450;
  intrinsics.width = 752;
  intrinsics.height = 480;
  Calibration calibration;
  calibration.left = Camera(intrinsics);
  calibration.right = calibration.left;
  calibration.right_from_left.translation.x() = -0.11;
  return calibration;
}

TEST(CalibrationFingerprint, ChangesWithWhatMovesThingsInImages) {
  const Calibration calibration = StereoCalibration();
  const std::uint64_t same = FingerprintOf(calibration, TestCamera());
  EXPECT_EQ(FingerprintOf(StereoCalibration(), TestCamera()), same);
  Calibration changed = calibration;
  changed.rate_hz = 30;
  changed.body_from_left = Rigid3();
  EXPECT_EQ(FingerprintOf(changed, TestCamera()), same);
  changed = calibration;
  changed.right_from_left.translation.x() += 1e-9;
  EXPECT_NE(FingerprintOf(changed, TestCamera()), same);
  changed = calibration;
  changed.right.reset();
  EXPECT_NE(FingerprintOf(changed, TestCamera()), same);
  CameraIntrinsics intrinsics = calibration.left.intrinsics();
  intrinsics.model = DistortionModel::kRadTan;
  intrinsics.distortion[0] = 1e-6;
  changed = calibration;
  changed.left = Camera(intrinsics);
  EXPECT_NE(FingerprintOf(changed, TestCamera()), same);
  RectifiedCamera camera = TestCamera();
  camera.baseline *= 2;
  EXPECT_NE(FingerprintOf(calibration, camera), same);
}

}  // namespace
}  // namespace plumbline
