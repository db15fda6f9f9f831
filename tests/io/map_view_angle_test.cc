// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file/map_view_angle.h"

#include "plumbline/image/rectify.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Calibration FisheyeCalibration() {
  CameraIntrinsics in;
  in.fx = in.fy = 190.9;
  in.cx = 254.9;
  in.cy = 256.8;
  in.width = in.height = 512;
  in.model = DistortionModel::kEquidistant;
  in.distortion = {0.0035, 0.0007, -0.002, 0.0002};
  Calibration calibration;
  calibration.left = Camera(in);
  return calibration;
}

TEST(ViewAngleOfMap, FindsTheAngleOfTheRun) {
  const Calibration calibration = FisheyeCalibration();
  for (const double degrees : {40.0, 75.0, 90.0, 135.0, 149.0}) {
    Calibration of_run = calibration;
    of_run.view_angle_deg = degrees;
    EXPECT_EQ(ViewAngleOfMap(Rectifier(of_run).camera(), calibration), degrees);
  }
  EXPECT_FALSE(ViewAngleOfMap(Rectifier(calibration).camera(), calibration)) << "as calibrated";
  RectifiedCamera other = Rectifier(calibration).camera();
  other.fx = other.fy = 200;
  EXPECT_FALSE(ViewAngleOfMap(other, calibration)) << "another camera";
}

TEST(ViewAngleDifference, NamesTheAnglesOfMapAndData) {
  const Calibration calibration = FisheyeCalibration();
  Calibration narrow = calibration, wide = calibration;
  narrow.view_angle_deg = 60;
  wide.view_angle_deg = 75;
  const RectifiedCamera of_wide = Rectifier(wide).camera();
  EXPECT_EQ(ViewAngleDifference(of_wide, narrow), "view angles of 75 and 60 degrees");
  EXPECT_EQ(ViewAngleDifference(Rectifier(calibration).camera(), narrow),
            "images cut out as by default and with a view angle of 60 degrees");
  EXPECT_FALSE(ViewAngleDifference(of_wide, wide));
  EXPECT_FALSE(ViewAngleDifference(of_wide, calibration)) << "no angle is asked for";
  RectifiedCamera other = of_wide;
  other.fx = other.fy = 200;
  EXPECT_FALSE(ViewAngleDifference(other, narrow)) << "another camera";
}

}  // namespace
}  // namespace plumbline
