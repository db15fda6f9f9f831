// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"

#include "tests/io/scratch_folder.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// One camera; `name` stands for the indent of its keys.
std::string CameraText(const std::string& name, const std::string& more) {
  return name + ":\n  camera_model: pinhole\n  intrinsics: [190, 191, 254, 256]\n" +
         "  distortion_model: equidistant\n  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]\n" +
         "  resolution: [512, 500]\n  timeshift_cam_imu: 0.001\n" + more;
}

const std::string kPair =
    CameraText("cam0", "") +
    CameraText("cam1",
               "  T_cn_cnm1:\n  - [1, 0, 0, -0.1]\n  - [0, 0, -1, 0.02]\n  - [0, 1, 0, 0.03]\n"
               "  - [0, 0, 0, 1]\n");

TEST(ReadKalibr, OneCameraIsMonocular) {
  const Calibration c = ParseCamera(CameraText("cam0", ""), "camchain.yaml");
  EXPECT_EQ(c.left,
            Camera({.fx = 190,
                    .fy = 191,
                    .cx = 254,
                    .cy = 256,
                    .width = 512,
                    .height = 500,
                    .model = DistortionModel::kEquidistant,
                    .distortion = {0.1, 0.2, 0.3, 0.4}}));
  EXPECT_FALSE(c.right);
  EXPECT_FALSE(c.rectified);
  EXPECT_FALSE(c.body_from_left);
}

TEST(ReadKalibr, TheSecondCameraStandsWhereItsMotionSays) {
  const Calibration c = ParseCamera(kPair, "camchain.yaml");
  ASSERT_TRUE(c.right);
  // T_cn_cnm1 takes points of cam0 to cam1.
  const Eigen::Vector3d in_right = c.right_from_left * Eigen::Vector3d(1, 2, 3);
  EXPECT_LT((in_right - Eigen::Vector3d(0.9, -2.98, 2.03)).norm(), 1e-12);
}

// OpenVINS writes the places of both at the inertial sensor alone, one way or the other.
TEST(ReadKalibr, ThePairFollowsFromThePlacesOfBothAtTheInertialSensor) {
  // Points of cam0, cam1 and the sensor: x0 = R (x - (1, 2, 3)), x1 = R (x - (1.1, 2, 3)), where R
  // turns by a right angle about x.
  const std::string rows_0 = "  - [1, 0, 0, -1]\n  - [0, 0, -1, 3]\n  - [0, 1, 0, -2]\n";
  const std::string rows_1 = "  - [1, 0, 0, -1.1]\n  - [0, 0, -1, 3]\n  - [0, 1, 0, -2]\n";
  const std::string back_0 = "  - [1, 0, 0, 1]\n  - [0, 0, 1, 2]\n  - [0, -1, 0, 3]\n";
  const std::string back_1 = "  - [1, 0, 0, 1.1]\n  - [0, 0, 1, 2]\n  - [0, -1, 0, 3]\n";
  const std::string last = "  - [0, 0, 0, 1]\n";
  const auto pair = [&](const std::string& key, const std::string& a, const std::string& b) {
    return CameraText("cam0", "  " + key + ":\n" + a + last) +
           CameraText("cam1", "  " + key + ":\n" + b + last);
  };
  for (const std::string& text :
       {pair("T_cam_imu", rows_0, rows_1), pair("T_imu_cam", back_0, back_1)}) {
    const Calibration c = ParseCamera("%YAML:1.0\n" + text, "kalibr_imucam_chain.yaml");
    ASSERT_TRUE(c.right);
    EXPECT_LT((c.right_from_left.translation - Eigen::Vector3d(-0.1, 0, 0)).norm(), 1e-12);
    EXPECT_LT(c.right_from_left.rotation.vec().norm(), 1e-12);
  }
  const auto message = [](const std::string& text) {
    return MessageOf([&] { ParseCamera(text, "x.yaml"); });
  };
  EXPECT_THAT(message(pair("T_imu_cam", back_1, back_0)),
              HasSubstr("x.yaml:21: cam1.T_imu_cam: expected the right camera"));
  EXPECT_THAT(message(CameraText("cam0", "  T_imu_cam:\n" + back_0 + last) +
                      CameraText("cam1", "  T_cam_imu:\n" + rows_1 + last)),
              HasSubstr("cam1.T_cn_cnm1: expected it, or T_cam_imu or T_imu_cam of both cameras"));
  // Kalibr's own counts.
  EXPECT_LT(
      (ParseCamera(pair("T_imu_cam", back_0, back_0) + kPair.substr(kPair.find("  T_cn_cnm1")),
                   "x.yaml")
           .right_from_left.translation -
       Eigen::Vector3d(-0.1, 0.02, 0.03))
          .norm(),
      1e-12);
}

// Folders of images have no times, and depth images no unit.
TEST(ReadKalibr, RateAndDepthFactorMayBeAdded) {
  const std::string added = "  rate_hz: 20\n  depth_factor: 5000\n";
  for (const std::string& text :
       {CameraText("cam0", added), CameraText("cam0", "") + "rate_hz: 20\ndepth_factor: 5000\n"}) {
    const Calibration c = ParseCamera(text, "camchain.yaml");
    EXPECT_EQ(c.rate_hz, 20);
    EXPECT_EQ(c.depth_factor, 5000);
  }
  const auto message = [](const std::string& text) {
    return MessageOf([&] { ParseCamera(text, "camchain.yaml"); });
  };
  EXPECT_EQ(message(CameraText("cam0", added) + "rate_hz: 20\n"),
            "camchain.yaml:10: rate_hz: expected it here or in cam0, found both");
  EXPECT_THAT(message(CameraText("cam0", "  rate_hz: 0\n")),
              HasSubstr("camchain.yaml:8: cam0.rate_hz: expected "));
  EXPECT_THAT(message(CameraText("cam0", "  rate_hz: 1000000\n")),
              HasSubstr("camchain.yaml:8: cam0.rate_hz: expected "));
  EXPECT_THAT(message(CameraText("cam0", "") + "depth_factor: 1.0e-9\n"),
              HasSubstr("camchain.yaml:8: depth_factor: expected "));
  EXPECT_FALSE(ParseCamera(CameraText("cam0", ""), "camchain.yaml").rate_hz);
}

std::string WideText(const std::string& model,
                     const std::string& intrinsics,
                     const std::string& distortion) {
  return "cam0:\n  cam_overlaps: []\n  camera_model: " + model +
         "\n  distortion_coeffs: " + distortion + "\n  intrinsics: [" + intrinsics +
         ", 190, 191, 254, 256]\n  resolution: [512, 500]\n  rostopic: /cam0/image_raw\n";
}

// The numbers of the projection stand before the focal lengths.
TEST(ReadKalibr, ReadsModelsOfSpheres) {
  using enum DistortionModel;
  const std::string none = "[]\n  distortion_model: none";
  const auto left = [](const std::string& text) {
    return ParseCamera(text, "camchain.yaml").left.intrinsics();
  };
  CameraIntrinsics expected{
      .fx = 190, .fy = 191, .cx = 254, .cy = 256, .width = 512, .height = 500};
  expected.model = kDoubleSphere;
  expected.distortion = {-0.2, 0.6};
  EXPECT_EQ(left(WideText("ds", "-0.2, 0.6", none)), expected);
  expected.model = kEucm;
  expected.distortion = {0.6, 1.1};
  EXPECT_EQ(left(WideText("eucm", "0.6, 1.1", none)), expected);
  expected.model = kOmni;
  expected.distortion = {0.8};
  EXPECT_EQ(left(WideText("omni", "0.8", none)), expected);
  expected.distortion = {0.8, -0.3, 0.1, 0.0005, 0.0006};
  EXPECT_EQ(
      left(WideText("omni", "0.8", "[-0.3, 0.1, 0.0005, 0.0006]\n  distortion_model: radtan")),
      expected);
  std::string fov = CameraText("cam0", "");
  fov.replace(fov.find("equidistant"), 11, "fov");
  fov.replace(fov.find("[0.1, 0.2, 0.3, 0.4]"), 20, "[0.9]");
  expected.model = kFov;
  expected.distortion = {0.9};
  EXPECT_EQ(left(fov), expected);
  EXPECT_THAT(MessageOf([&] { ParseCamera(WideText("ds", "0.1", none), "camchain.yaml"); }),
              HasSubstr("camchain.yaml:6: cam0.intrinsics: expected 6 numbers, found 5"));
  EXPECT_THAT(MessageOf([&] { ParseCamera(WideText("eucm", "0.1, -1", none), "camchain.yaml"); }),
              HasSubstr("camchain.yaml:6: cam0.intrinsics: eucm: expected beta above 0, found -1"));
  // The key is that of the number, wherever the others of the model stand.
  EXPECT_THAT(MessageOf([&] {
                ParseCamera(WideText("omni", "-1", "[0, 0, 0, 0]\n  distortion_model: radtan"),
                            "camchain.yaml");
              }),
              HasSubstr("camchain.yaml:6: cam0.intrinsics: omni: expected xi from 0"));
}

TEST(ReadKalibr, BadFilesAreNamedByLineAndKey) {
  const auto message = [](const std::string& from, const std::string& to) {
    std::string text = kPair;
    text.replace(text.find(from), from.size(), to);
    return MessageOf([&] { ParseCamera(text, "camchain.yaml"); });
  };
  EXPECT_EQ(message("cam0", "cam0"), "no error");
  EXPECT_EQ(message("pinhole", "scaramuzza"),
            "camchain.yaml:2: cam0.camera_model: expected pinhole, omni, ds or eucm, found "
            "'scaramuzza'");
  EXPECT_EQ(message("equidistant", "thin_prism"),
            "camchain.yaml:4: cam0.distortion_model: expected radtan, equidistant, fov or none, "
            "found 'thin_prism'");
  EXPECT_EQ(message("pinhole", "ds"),
            "camchain.yaml:4: cam0.distortion_model: expected none with ds, found 'equidistant'");
  EXPECT_EQ(message("pinhole", "omni"),
            "camchain.yaml:4: cam0.distortion_model: expected radtan or none with omni, found "
            "'equidistant'");
  EXPECT_THAT(message("0.3, 0.4]", "0.3]"),
              HasSubstr("camchain.yaml:5: cam0.distortion_coeffs: expected 4 numbers, found 3"));
  EXPECT_THAT(message("[512, 500]", "[512]"), HasSubstr("cam0.resolution: expected 2 numbers"));
  EXPECT_THAT(
      message("T_cn_cnm1", "T_cam_imu"),
      HasSubstr("camchain.yaml:9: cam1.T_cn_cnm1: expected it, or T_cam_imu or T_imu_cam of "
                "both cameras, found none"));
  EXPECT_THAT(message("[0, 0, 0, 1]", "[0, 0, 0]"),
              HasSubstr("cam1.T_cn_cnm1: expected 4 rows of 4 numbers, found a row of 3"));
  EXPECT_THAT(message("[0, 1, 0, 0.03]", "[0, 2, 0, 0.03]"),
              HasSubstr("cam1.T_cn_cnm1: expected a rigid motion"));
  EXPECT_THAT(
      message("[1, 0, 0, -0.1]", "[1, 0, 0, 0.1]"),
      HasSubstr("camchain.yaml:16: cam1.T_cn_cnm1: expected the right camera to the right"));
  EXPECT_EQ(message("cam0:", "cam2:"),
            "camchain.yaml:9: cam1: expected cam0, the left camera, beside it, found none");
}

}  // namespace
}  // namespace plumbline
