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
namespace opencv_calibration_test {

using testing::HasSubstr;

// One camera as OpenCV's calibration program and ROS's camera_calibration write it, which are among
// the seeds of the fuzzer.
const std::string kOpenCv = Contents(PLUMBLINE_SEEDS "/camera/opencv");
const std::string kRos = Contents(PLUMBLINE_SEEDS "/camera/ros");

// The text with one piece replaced, which must be there.
std::string With(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string CoefficientsOf(const std::string& numbers) {
  return "image_width: 640\nimage_height: 480\n"
         "camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 510, 240, 0, 0, 1]}\n"
         "distortion_coefficients: {rows: 1, data: [" +
         numbers + "]}\n";
}

Camera Parse(const std::string& text) { return ParseCamera(text, "ost.yaml").left; }

std::string MessageFor(const std::string& text) {
  return MessageOf([&] { Parse(text); });
}

TEST(ReadOpenCvCalibration, ReadsWhatBothProgramsWrite) {
  for (const std::string& text : {kOpenCv, kRos}) {
    const Calibration c = ParseCamera(text, "ost.yaml");
    const CameraIntrinsics& k = c.left.intrinsics();
    EXPECT_EQ(k.width, 640);
    EXPECT_EQ(k.height, 480);
    EXPECT_NEAR(k.fx, 535.915733961632, 1e-12);
    EXPECT_NEAR(k.fy, 535.915733961632, 1e-12);
    EXPECT_NEAR(k.cx, 342.2831547330837, 1e-12);
    EXPECT_NEAR(k.cy, 235.5708290978817, 1e-12);
    EXPECT_EQ(k.model, DistortionModel::kRadTan);
    EXPECT_NEAR(k.distortion[1], -0.03858889892230465, 1e-15);
    EXPECT_NEAR(k.distortion[4], 0.2383915308087849, 1e-15);
    EXPECT_FALSE(c.right);
    EXPECT_FALSE(c.rectified);
    EXPECT_FALSE(c.rate_hz);
  }
}

TEST(ReadOpenCvCalibration, IsToldByItsNameAndTakesNoOtherFormat) {
  const ScratchFolder folder;
  const std::string ost = folder.Write("ost.yaml", kRos).string();
  EXPECT_EQ(ReadCameraFile(ost).source, ost + " (OpenCV or ROS calibration)");
  const std::string ours =
      folder
          .Write("ours.yaml",
                 "size: [640, 480]\nintrinsics: [500, 510, 320, 240]\ndistortion: radtan\n"
                 "distortion_coefficients: [0.1, 0, 0, 0]\n")
          .string();
  EXPECT_EQ(ReadCameraFile(ours).source, ours + " (Plumbline camera file)");
}

TEST(ReadOpenCvCalibration, RateAndDepthFactorMayBeAdded) {
  const Calibration c = ParseCamera(kRos + "rate_hz: 30\ndepth_factor: 1000\n", "ost.yaml");
  EXPECT_EQ(c.rate_hz, 30);
  EXPECT_EQ(c.depth_factor, 1000);
  EXPECT_THAT(MessageFor(kRos + "rate_hz: 1000000\n"),
              HasSubstr("ost.yaml:21: rate_hz: expected a rate from"));
  EXPECT_THAT(MessageFor(kRos + "depth_factor: 1.0e-9\n"),
              HasSubstr("ost.yaml:21: depth_factor: expected a depth factor from"));
}

TEST(ReadOpenCvCalibration, KnowsAFisheyeByItsModel) {
  const std::string four = CoefficientsOf("0.1, 0.02, -0.003, 0.0004");
  for (const char* row : {"distortion_model: equidistant\n",
                          "distortion_model: fisheye\n",
                          "fisheye_model: 1\n",
                          "fisheye_model: true\n"}) {
    const CameraIntrinsics k = Parse(four + row).intrinsics();
    EXPECT_EQ(k.model, DistortionModel::kEquidistant) << row;
    EXPECT_EQ(k.distortion[3], 0.0004) << row;
    EXPECT_THAT(MessageFor(CoefficientsOf("0.1, 0.02, 0, 0, 0") + row),
                HasSubstr("ost.yaml:4: distortion_coefficients.data: expected 4 numbers, found 5"));
  }
  for (const char* row :
       {"", "fisheye_model: 0\n", "fisheye_model: false\n", "distortion_model: plumb_bob\n"}) {
    EXPECT_EQ(Parse(four + row).intrinsics().model, DistortionModel::kRadTan) << row;
  }
  EXPECT_EQ(MessageFor(four + "distortion_model: thin_prism\n"),
            "ost.yaml:5: distortion_model: expected plumb_bob, rational_polynomial, equidistant or "
            "fisheye, found 'thin_prism'");
}

TEST(ReadOpenCvCalibration, CoefficientsBehindTheFifthAreZero) {
  const CameraIntrinsics expected =
      Parse(CoefficientsOf("0.1, -0.02, 0.001, 0.002, 0.3")).intrinsics();
  EXPECT_EQ(expected.distortion[4], 0.3);
  for (const char* zeros : {", 0, 0, 0", ", 0, 0, 0, 0, 0, 0, 0", ", 0, 0, 0, 0, 0, 0, 0, 0, 0"}) {
    const std::string text = CoefficientsOf(std::string("0.1, -0.02, 0.001, 0.002, 0.3") + zeros);
    EXPECT_EQ(Parse(text + "distortion_model: rational_polynomial\n").intrinsics(), expected);
  }
  EXPECT_EQ(MessageFor(CoefficientsOf("0.1, -0.02, 0.001, 0.002, 0.3, 0, 0.5, 0, 0, 0.01, 0, 0")),
            "ost.yaml:4: distortion_coefficients.data: expected k1, k2, p1, p2, k3, k4, k5, k6 and "
            "then zeros, found 0.01 as number 10; calibrate without the thin prism and tilted "
            "models");
  EXPECT_THAT(MessageFor(CoefficientsOf("0.1, -0.02")),
              HasSubstr("expected 4 or 5 or 8 or 12 or 14 numbers, found 2"));
  EXPECT_TRUE(Parse(CoefficientsOf("0, 0, 0, 0, 0")).IsIdeal());
}

// As depth cameras have it.
TEST(ReadOpenCvCalibration, EightCoefficientsAreRational) {
  const std::string eight = "0.4, -2.5, 0.001, 0.002, 1.4, 0.3, -2.3, 1.35";
  for (const std::string& text :
       {CoefficientsOf(eight),
        CoefficientsOf(eight + ", 0, 0, 0, 0, 0, 0"),
        CoefficientsOf(eight) + "distortion_model: rational_polynomial\n"}) {
    const CameraIntrinsics k = Parse(text).intrinsics();
    EXPECT_EQ(k.model, DistortionModel::kRational);
    EXPECT_THAT(k.distortion, testing::ElementsAre(0.4, -2.5, 0.001, 0.002, 1.4, 0.3, -2.3, 1.35));
  }
}

// cv::FileStorage writes JSON, too.
TEST(ReadOpenCvCalibration, ReadsJson) {
  const std::string json =
      "{\n    \"image_width\": 640,\n    \"image_height\": 480,\n    \"camera_matrix\": {\n"
      "        \"type_id\": \"opencv-matrix\",\n        \"rows\": 3,\n        \"cols\": 3,\n"
      "        \"dt\": \"d\",\n        \"data\": [ 5.0e+02, 0.0, 320, 0.0,\n            510, 240, "
      "0.0, 0.0, 1.0 ]\n    },\n    \"distortion_coefficients\": {\n        \"type_id\": "
      "\"opencv-matrix\",\n        \"rows\": 5,\n        \"cols\": 1,\n        \"dt\": \"d\",\n"
      "        \"data\": [ 0.1, -0.02, 0.001, 0.002, 0.3 ]\n    }\n}\n";
  EXPECT_EQ(Parse(json), Parse(CoefficientsOf("0.1, -0.02, 0.001, 0.002, 0.3")));
  EXPECT_THAT(MessageFor(With(json, "5.0e+02", "-5")),
              HasSubstr("ost.yaml:4: camera_matrix: expected fx"));
}

TEST(ReadOpenCvCalibration, KnowsAnOmnidirectionalCameraByXi) {
  const CameraIntrinsics k =
      Parse(CoefficientsOf("0.1, 0.02, -0.003, 0.0004") + "xi: 1.2\n").intrinsics();
  EXPECT_EQ(k.model, DistortionModel::kOmni);
  EXPECT_THAT(k.distortion, testing::ElementsAre(1.2, 0.1, 0.02, -0.003, 0.0004, 0, 0, 0));
  // cv::omnidir::calibrate gives xi as a matrix.
  const std::string numbers = CoefficientsOf("0.1, 0.02, -0.003, 0.0004");
  const std::string xi =
      "xi: !!opencv-matrix\n   rows: 1\n   cols: 1\n   dt: d\n   data: [ 1.2 ]\n";
  EXPECT_EQ(Parse(numbers + xi).intrinsics(), k);
  EXPECT_THAT(MessageFor(numbers + "xi: -2\n"), HasSubstr(": xi: omni: expected xi from 0"));
  EXPECT_THAT(MessageFor(CoefficientsOf("-40, 0, 0, 0") + "xi: 1\n"),
              HasSubstr("distortion_coefficients: expected a distortion that has a ray"));
}

TEST(ReadOpenCvCalibration, BadFilesAreNamedByLineAndKey) {
  EXPECT_EQ(MessageFor(With(kRos, "image_width: 640\n", "")),
            "ost.yaml:1: image_width: expected the size of the images in pixels, found none; add "
            "the row");
  EXPECT_THAT(MessageFor(With(kRos, "640", "640.5")),
              HasSubstr("ost.yaml:1: image_width: expected whole numbers"));
  EXPECT_EQ(MessageFor(With(kRos, "[535.9157339616320, 0.000000", "[535.9157339616320, 0.100000")),
            "ost.yaml:5: camera_matrix: expected fx 0 cx, 0 fy cy, 0 0 1");
  EXPECT_THAT(
      MessageFor(With(kRos, "535.9157339616320", "-535")),
      HasSubstr("ost.yaml:5: camera_matrix: expected fx from 6.4 to 640000 px, found -535"));
  EXPECT_THAT(MessageFor(With(kRos, "cols: 3", "cols: 4")),
              HasSubstr("ost.yaml:6: camera_matrix.cols: expected 3, found 4"));
  EXPECT_THAT(MessageFor(With(kRos, "[-0.2663726090966068", "[-40")),
              HasSubstr("distortion_coefficients: expected a distortion that has a ray"));
  EXPECT_THAT(MessageFor(With(kRos, "distortion_coefficients", "D")),
              HasSubstr("distortion_coefficients: expected a group of keys, found none"));
}

}  // namespace opencv_calibration_test
}  // namespace plumbline
