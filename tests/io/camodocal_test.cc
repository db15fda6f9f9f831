// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"

#include "tests/io/scratch_folder.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace camodocal_test {

using testing::HasSubstr;

// EuRoC's left camera as the configuration of VINS-Mono has it.
const std::string kEurocCamera =
    "%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: camera\nimage_width: 752\n"
    "image_height: 480\ndistortion_parameters:\n   k1: -0.28\n   k2: 0.07\n   p1: 0.0002\n"
    "   p2: 1.8e-05\nprojection_parameters:\n   fx: 458.6\n   fy: 457.3\n   cx: 367.2\n"
    "   cy: 248.4\n";

TEST(ReadCamodocal, ReadsPinholeAndKannalaBrandt) {
  EXPECT_EQ(ParseCamera(kEurocCamera, "cam0.yaml").left,
            Camera({.fx = 458.6,
                    .fy = 457.3,
                    .cx = 367.2,
                    .cy = 248.4,
                    .width = 752,
                    .height = 480,
                    .model = DistortionModel::kRadTan,
                    .distortion = {-0.28, 0.07, 0.0002, 1.8e-05}}));
  const std::string fisheye =
      "%YAML:1.0\n---\nmodel_type: KANNALA_BRANDT\ncamera_name: cam0\nimage_width: 848\n"
      "image_height: 800\nprojection_parameters:\n   k2: 0.1\n   k3: 0.2\n   k4: 0.3\n"
      "   k5: 0.4\n   mu: 190\n   mv: 191\n   u0: 254\n   v0: 256\nrate_hz: 30\n";
  const Calibration c = ParseCamera(fisheye, "cam0.yaml");
  EXPECT_EQ(c.left,
            Camera({.fx = 190,
                    .fy = 191,
                    .cx = 254,
                    .cy = 256,
                    .width = 848,
                    .height = 800,
                    .model = DistortionModel::kEquidistant,
                    .distortion = {0.1, 0.2, 0.3, 0.4}}));
  EXPECT_EQ(c.rate_hz, 30);
}

TEST(ReadCamodocal, ReadsMei) {
  const std::string mei =
      "%YAML:1.0\n---\nmodel_type: MEI\ncamera_name: camera\nimage_width: 720\nimage_height: 540\n"
      "mirror_parameters:\n   xi: 1.9\ndistortion_parameters:\n   k1: -0.03\n   k2: 0.1\n"
      "   p1: 0.0001\n   p2: -0.001\nprojection_parameters:\n   gamma1: 669\n   gamma2: 668\n"
      "   u0: 377\n   v0: 279\n";
  EXPECT_EQ(ParseCamera(mei, "cam0.yaml").left,
            Camera({.fx = 669,
                    .fy = 668,
                    .cx = 377,
                    .cy = 279,
                    .width = 720,
                    .height = 540,
                    .model = DistortionModel::kOmni,
                    .distortion = {1.9, -0.03, 0.1, 0.0001, -0.001}}));
  std::string wrong = mei;
  wrong.replace(wrong.find("1.9"), 3, "-1.9");
  EXPECT_THAT(
      MessageOf([&] { ParseCamera(wrong, "cam0.yaml"); }),
      HasSubstr("cam0.yaml:8: mirror_parameters: omni: expected xi from 0 to 1000, found -1.9"));
}

TEST(ReadCamodocal, SaysWhatIsWrong) {
  const auto message = [](const std::string& from, const std::string& to) {
    std::string text = kEurocCamera;
    text.replace(text.find(from), from.size(), to);
    return MessageOf([&] { ParseCamera(text, "cam0.yaml"); });
  };
  EXPECT_THAT(message("PINHOLE", "SCARAMUZZA"),
              HasSubstr("cam0.yaml:3: model_type: expected PINHOLE, KANNALA_BRANDT or MEI, found "
                        "'SCARAMUZZA'"));
  EXPECT_THAT(message("   fx: 458.6\n", ""), HasSubstr("projection_parameters.fx: expected"));
  EXPECT_THAT(message("458.6", "-458.6"), HasSubstr("projection_parameters: expected fx"));
  EXPECT_THAT(message("image_width: 752\n", ""), HasSubstr("image_width: expected the size"));
  EXPECT_THAT(message("k1: -0.28", "k1: x"), HasSubstr("distortion_parameters.k1: expected"));
}

}  // namespace camodocal_test
}  // namespace plumbline
