// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"

#include "tests/io/scratch_folder.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

std::string Rows(const std::string& prefix, const std::vector<std::string>& rows) {
  std::string text;
  for (const std::string& row : rows) text += prefix + row + "\n";
  return text;
}

const std::string kOld = "%YAML:1.0\n" + Rows("Camera.",
                                              {"fx: 500",
                                               "fy: 510",
                                               "cx: 320",
                                               "cy: 240",
                                               "width: 640",
                                               "height: 480",
                                               "fps: 30.0",
                                               "RGB: 1"});
const std::string kLens = Rows("Camera.", {"k1: 0.1", "k2: -0.2", "p1: 0.001", "p2: 0.002"});

const std::string kFisheye =
    "%YAML:1.0\n---\nFile.version: \"1.0\"\nCamera.type: \"KannalaBrandt8\"\n" +
    Rows("Camera1.",
         {"fx: 190", "fy: 191", "cx: 254", "cy: 256", "k1: 0.1", "k2: 0.2", "k3: 0.3", "k4: 0.4"}) +
    Rows("Camera2.",
         {"fx: 180", "fy: 181", "cx: 244", "cy: 246", "k1: 0.5", "k2: 0.6", "k3: 0.7", "k4: 0.8"}) +
    Rows("Camera.", {"width: 512", "height: 512", "fps: 20", "RGB: 1"}) +
    "Stereo.T_c1_c2: !!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: f\n"
    "  data: [0, -1, 0, 0.1,\n         1, 0, 0, 0.02,\n         0, 0, 1, 0.03,\n"
    "         0, 0, 0, 1]\n";

Calibration Parse(const std::string& text) { return ParseCamera(text, "settings.yaml"); }

TEST(ReadOrbSlamSettings, OneCameraWithDistortion) {
  const Calibration c = Parse(kOld + kLens + "Camera.k3: 0.3\n");
  EXPECT_EQ(c.left,
            Camera({.fx = 500,
                    .fy = 510,
                    .cx = 320,
                    .cy = 240,
                    .width = 640,
                    .height = 480,
                    .model = DistortionModel::kRadTan,
                    .distortion = {0.1, -0.2, 0.001, 0.002, 0.3}}));
  EXPECT_EQ(c.rate_hz, 30);
  EXPECT_FALSE(c.right);
  EXPECT_FALSE(c.depth_factor);
}

TEST(ReadOrbSlamSettings, BaselineTimesFocalLengthMakesARectifiedPair) {
  const Calibration c = Parse(
      kOld + "Camera.k1: 0.0\nCamera.k2: 0.0\nCamera.p1: 0\nCamera.p2: 0\n" + "Camera.bf: 60\n");
  ASSERT_TRUE(c.right);
  EXPECT_TRUE(c.rectified);
  EXPECT_TRUE(c.left.IsIdeal());
  EXPECT_EQ(*c.right, c.left);
  EXPECT_DOUBLE_EQ(c.right_from_left.translation.x(), -0.12);
}

TEST(ReadOrbSlamSettings, DepthTakesBaselineAsThatOfNoRealCamera) {
  const Calibration c = Parse(kOld + kLens + "Camera.bf: 40.0\nDepthMapFactor: 5208.0\n");
  EXPECT_EQ(c.depth_factor, 5208);
  EXPECT_FALSE(c.right);
  EXPECT_FALSE(c.rectified);
}

TEST(ReadOrbSlamSettings, NewFormOfDepth) {
  const Calibration c = Parse(
      "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"PinHole\"\n"
      "Camera1.fx: 535.4\nCamera1.fy: 539.2\nCamera1.cx: 320.1\nCamera1.cy: 247.6\n"
      "Camera.width: 640\nCamera.height: 480\nCamera.fps: 30\nStereo.ThDepth: 40.0\n"
      "Stereo.b: 0.0747\nRGBD.DepthMapFactor: 5000.0\n");
  EXPECT_EQ(c.left.intrinsics().fy, 539.2);
  EXPECT_EQ(c.left.intrinsics().model, DistortionModel::kNone);
  EXPECT_EQ(c.depth_factor, 5000);
  EXPECT_FALSE(c.right);
}

TEST(ReadOrbSlamSettings, NewFormOfARectifiedPair) {
  const Calibration c = Parse(
      "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"Rectified\"\n"
      "Camera1.fx: 700\nCamera1.fy: 700\nCamera1.cx: 600\nCamera1.cy: 180\n"
      "Camera.width: 1241\nCamera.height: 376\nStereo.ThDepth: 40.0\nStereo.b: 0.537\n");
  ASSERT_TRUE(c.right);
  EXPECT_TRUE(c.rectified);
  EXPECT_EQ(c.right_from_left.translation, Eigen::Vector3d(-0.537, 0, 0));
  EXPECT_FALSE(c.rate_hz);
}

TEST(ReadOrbSlamSettings, ThePoseOfTheSecondCameraIsInverted) {
  const Calibration c = Parse(kFisheye);
  ASSERT_TRUE(c.right);
  EXPECT_EQ(c.left.intrinsics().model, DistortionModel::kEquidistant);
  EXPECT_EQ(c.right->intrinsics().distortion[3], 0.8);
  // The origin of camera 2 in camera 1 is the last column.
  const Eigen::Vector3d origin(0.1, 0.02, 0.03);
  EXPECT_LT((c.right_from_left * origin).norm(), 1e-12);
  // Its x axis points along the y axis of camera 1.
  const Eigen::Vector3d one = c.right_from_left * (origin + Eigen::Vector3d(0, 1, 0));
  EXPECT_LT((one - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(ReadOrbSlamSettings, OlderFormOfTheSecondCamera) {
  std::string text = kFisheye;
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from)) {
      text.replace(at, from.size(), to);
    }
  };
  replace("File.version: \"1.0\"\n", "");
  replace("Camera1.", "Camera.");
  replace("Stereo.T_c1_c2", "Tlr");
  replace("  rows: 4", "  rows: 3");
  replace(",\n         0, 0, 0, 1]", "]");
  const Calibration c = Parse(text);
  const Calibration expected = Parse(kFisheye);
  EXPECT_EQ(c.left, expected.left);
  EXPECT_EQ(c.right, expected.right);
  EXPECT_LT(LogSe3(c.right_from_left * Inverse(expected.right_from_left)).norm(), 1e-12);
}

TEST(ReadOrbSlamSettings, BadFilesAreNamedByLineAndKey) {
  const auto message = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return "no '" + from + "'";
    text.replace(at, from.size(), to);
    return MessageOf([&] { Parse(text); });
  };
  EXPECT_EQ(message(kOld, "fx: 500", "fx: five"),
            "settings.yaml:2: Camera.fx: expected a number, found 'five'");
  EXPECT_THAT(
      message(kOld, "fx: 500", "fx: -500"),
      HasSubstr("settings.yaml:2: Camera.fx: expected fx from 6.4 to 640000 px, found -500"));
  EXPECT_THAT(
      message(kOld, "fy: 510", "fy: -510"),
      HasSubstr("settings.yaml:3: Camera.fy: expected fy from 6.4 to 640000 px, found -510"));
  EXPECT_THAT(message(kOld, "cx: 320", "cx: 32000"),
              HasSubstr("settings.yaml:4: Camera.cx: expected cx from -6400 to 7040 px"));
  EXPECT_THAT(message(kOld, "cy: 240", "cy: 1e9"),
              HasSubstr("settings.yaml:5: Camera.cy: expected cy from -6400 to 7040 px"));
  EXPECT_THAT(message(kOld, "Camera.fy: 510\n", ""),
              HasSubstr("Camera.fy: expected a value, found none"));
  EXPECT_THAT(message(kFisheye, "Camera1.fx: 190\n", ""),
              HasSubstr("Camera1.fx: expected a value, found none"));
  EXPECT_THAT(message(kFisheye, "Camera2.fx: 180\n", ""),
              HasSubstr("Camera2.fx: expected a value, found none"));
  EXPECT_THAT(message(kOld, "Camera.cx: 320\n", ""),
              HasSubstr("Camera.cx: expected a value, found none"));
  EXPECT_THAT(message(kOld, "Camera.width: 640\n", ""),
              HasSubstr("Camera.width: expected the size of the images in pixels, found none"));
  EXPECT_THAT(message(kOld, "640", "640.5"), HasSubstr("Camera.width: expected whole numbers"));
  EXPECT_THAT(message(kOld + kLens, "Camera.p1: 0.001\n", ""),
              HasSubstr("Camera.p1: expected a value, found none"));
  EXPECT_THAT(message(kOld + kLens, "RGB: 1", "bf: 40"),
              HasSubstr("settings.yaml:9: Camera.bf: expected a rectified camera with it"));
  EXPECT_THAT(message(kOld, "RGB: 1", "bf: -40"),
              HasSubstr("Camera.bf: expected a number above 0"));
  EXPECT_THAT(message(kOld, "RGB: 1", "bf: 1e300"),
              HasSubstr("settings.yaml:9: Camera.bf: expected a baseline from 0.0001 to 1000 m"));
  EXPECT_THAT(message(kOld, "fps: 30.0", "fps: 1e300"),
              HasSubstr("settings.yaml:8: Camera.fps: expected a rate from"));
  EXPECT_THAT(message(kOld, "RGB: 1", "fps: 30"),
              HasSubstr("settings.yaml:9: expected each key once, found 'Camera.fps' again"));
  EXPECT_THAT(
      message(kFisheye, "-1, 0, 0.1", "-1, 0, -0.1"),
      HasSubstr("settings.yaml:25: Stereo.T_c1_c2: expected the right camera to the right"));
  EXPECT_THAT(message(kFisheye, "KannalaBrandt8", "Omni"),
              HasSubstr("settings.yaml:4: Camera.type: expected PinHole, KannalaBrandt8 or "
                        "Rectified, found 'Omni'"));
  EXPECT_THAT(message(kFisheye, "Camera2.k4: 0.8\n", ""),
              HasSubstr("Camera2.k4: expected a value"));
  EXPECT_THAT(message(kFisheye, "T_c1_c2", "T_c2_c1"),
              HasSubstr("Stereo.T_c1_c2: expected 16 numbers, found no list"));
  EXPECT_THAT(message(kFisheye, "rows: 4", "rows: 3"),
              HasSubstr("settings.yaml:26: Stereo.T_c1_c2.rows: expected 4, found 3"));
  EXPECT_THAT(message(kFisheye, "1, 0, 0, 0.02", "1, 1, 0, 0.02"),
              HasSubstr("Stereo.T_c1_c2: expected a rigid motion"));
}

}  // namespace
}  // namespace plumbline
