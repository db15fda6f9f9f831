// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_formats.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include "tests/support/euroc_calibration.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

TEST(ReadEurocSensor, ReadsTheRealCamera) {
  const auto folder = FindData("euroc/MH_01_easy_first250/mav0");
  if (!folder) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const Calibration expected = EurocCalibration();
  const EurocSensor left = ReadEurocSensor(*folder / "cam0" / "sensor.yaml");
  const EurocSensor right = ReadEurocSensor(*folder / "cam1" / "sensor.yaml");
  EXPECT_EQ(left.camera, expected.left);
  EXPECT_EQ(right.camera, *expected.right);
  EXPECT_EQ(left.rate_hz, 20);
  EXPECT_LT(LogSe3(Inverse(right.body_from_camera) * left.body_from_camera *
                   Inverse(expected.right_from_left))
                .norm(),
            1e-14);
}

TEST(ReadEurocSensor, BadFilesAreNamed) {
  const ScratchFolder folder;
  const std::string good =
      "T_BS:\n  cols: 4\n  rows: 4\n  data: [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n"
      "rate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [450, 450, 376, "
      "240]\n"
      "distortion_model: equidistant\ndistortion_coefficients: [0, 0, 0, 0]\n";
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    return MessageOf([&] { ReadEurocSensor(folder.Write("sensor.yaml", text)); });
  };
  EXPECT_EQ(message("", ""), "no error");
  EXPECT_THAT(message("pinhole", "omni"),
              HasSubstr("sensor.yaml:7: camera_model: expected pinhole"));
  EXPECT_THAT(message("equidistant", "thin_prism"),
              HasSubstr("sensor.yaml:9: distortion_model: expected"));
  EXPECT_THAT(message("T_BS", "T_SB"), HasSubstr("T_BS: expected a group of keys"));
  EXPECT_THAT(message("0,0,0,1]", "0,0,0,2]"),
              HasSubstr("last row 0 0 0 1), found the last row 0 0 0 2"));
  EXPECT_THAT(message("[1,0,0,0,", "[2,0,0,0,"), HasSubstr("found a matrix 3 off a rotation"));
  EXPECT_THAT(message("0,0,0,1]", "0,0,0]"), HasSubstr("T_BS.data: expected 16 numbers, found 15"));
  EXPECT_THAT(message("rate_hz: 20", "rate_hz: 1e300"),
              HasSubstr("sensor.yaml:5: rate_hz: expected a rate from 0.0001 to 100000 Hz"));
  EXPECT_THAT(message("1,0,0,0, ", "1,0,0,1e99, "),
              HasSubstr("sensor.yaml:2: T_BS: expected a body at most 10000 m from the camera"));
  EXPECT_THAT(message("rate_hz: 20\n", ""), HasSubstr("rate_hz: expected a value, found none"));
}

}  // namespace
}  // namespace plumbline
