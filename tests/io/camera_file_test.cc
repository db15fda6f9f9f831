// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_file.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include "tests/support/euroc_calibration.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kMono[] = "model: pinhole\nsize: [640, 480]\nintrinsics: [500, 510, 320.5, 240]\n";

TEST(ParseCamera, ReadsAMonocularCamera) {
  const Calibration c = ParseCamera(std::string(kMono) +
                                        "distortion: radtan\n"
                                        "distortion_coefficients: [0.1, -0.2, 0.001, -0.002]\n"
                                        "rate_hz: 30\ndepth_factor: 5000\n",
                                    "c.yaml");
  EXPECT_EQ(c.left,
            Camera({.fx = 500,
                    .fy = 510,
                    .cx = 320.5,
                    .cy = 240,
                    .width = 640,
                    .height = 480,
                    .model = DistortionModel::kRadTan,
                    .distortion = {0.1, -0.2, 0.001, -0.002, 0}}));
  EXPECT_EQ(c.rate_hz, 30);
  EXPECT_EQ(c.depth_factor, 5000);
  EXPECT_FALSE(c.right);
  EXPECT_FALSE(c.rectified);
}

TEST(ParseCamera, BaselineMakesARectifiedPair) {
  const Calibration c =
      ParseCamera(std::string(kMono) + "rectified: true\nbaseline: 0.12\n", "c.yaml");
  ASSERT_TRUE(c.right);
  EXPECT_EQ(*c.right, c.left);
  EXPECT_TRUE(c.rectified);
  EXPECT_EQ(c.right_from_left.translation, Eigen::Vector3d(-0.12, 0, 0));
}

TEST(FormatCamera, RoundTripKeepsTheNumbers) {
  Calibration c = EurocCalibration();
  const Calibration read = ParseCamera(FormatCamera(c), "c.yaml");
  EXPECT_EQ(read.left, c.left);
  EXPECT_EQ(read.right, c.right);
  EXPECT_EQ(read.rate_hz, c.rate_hz);
  EXPECT_LT(LogSe3(read.right_from_left * Inverse(c.right_from_left)).norm(), 1e-14);
  EXPECT_LT(LogSe3(*read.body_from_left * Inverse(*c.body_from_left)).norm(), 1e-14);
  c.right.reset();
  c.depth_factor = 1234.5;
  EXPECT_EQ(ParseCamera(FormatCamera(c), "c.yaml").depth_factor, 1234.5);
  EXPECT_FALSE(ParseCamera(FormatCamera(c), "c.yaml").right);
}

TEST(ParseCamera, BadFilesAreNamedByLineAndKey) {
  struct Case {
    std::string yaml;
    std::string message;
  };
  const std::string mono = kMono;
  const std::string pair = "right_from_left: [1,0,0,-0.1, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n";
  const std::vector<Case> cases = {
      {"", "c.yaml:1: expected 'key: value' rows"},
      {"a: [1", "c.yaml:"},
      {mono + "distorsion: none\n",
       "c.yaml:4: unknown key 'distorsion'; did you mean 'distortion'?"},
      {"size: [640, 480]\n", "intrinsics: expected 4 numbers, found no list"},
      {"size: [640]\nintrinsics: [1,1,1,1]\n", "c.yaml:1: size: expected 2 numbers, found 1"},
      {"size: [640, a]\nintrinsics: [1,1,1,1]\n", "c.yaml:1: size: expected 2 numbers, found 'a'"},
      {"size: [640, 0]\nintrinsics: [1,1,1,1]\n", "size: expected whole numbers above 0, found 0"},
      {"size: [640.5, 9]\nintrinsics: [1,1,1,1]\n", "size: expected whole numbers above 0"},
      {"size: [640, 480]\nintrinsics: [-5,1,1,1]\n", "c.yaml:2: intrinsics: camera: expected fx"},
      {mono + "distortion: fisheye\n",
       "c.yaml:4: distortion: expected none, radtan or equidistant, found 'fisheye'"},
      {mono + "distortion: radtan\n", "distortion_coefficients: expected 4 or 5 numbers"},
      {mono + "distortion: equidistant\ndistortion_coefficients: [1, 2, 3, 4, 5]\n",
       "c.yaml:5: distortion_coefficients: expected 4 numbers, found 5"},
      {mono + "distortion_coefficients: [1, 2, 3, 4]\n", "expected none without a distortion"},
      {mono + "rate_hz: 0\n", "c.yaml:4: rate_hz: expected a number above 0, found '0'"},
      {mono + "depth_factor: [1]\n", "c.yaml:4: depth_factor: expected one value"},
      {mono + "rectified: yes\n", "c.yaml:4: rectified: expected true or false, found yes"},
      {mono + "baseline: 0.1\n", "c.yaml:4: baseline: expected `rectified: true`"},
      {mono + "rectified: true\nbaseline: -0.1\n", "baseline: expected a number above 0"},
      {mono + pair, "right_from_left: expected a camera `right` with it"},
      {mono + "right: {size: [640, 480], intrinsics: [1, 1, 1, 1]}\n",
       "c.yaml:4: right: expected right_from_left"},
      {mono + "right: 5\n", "c.yaml:4: right: expected a group of keys"},
      {mono + "right:\n  siez: [640, 480]\n", "c.yaml:5: unknown key 'right.siez'"},
      {mono + "right:\n  size: [640, 480]\n" + pair, "right.intrinsics: expected 4 numbers"},
      {mono + "body_from_left: [2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n",
       "c.yaml:4: body_from_left: expected a rigid motion"},
      {mono + "rectified: true\nright: {size: [640, 480], intrinsics: [1, 1, 1, 1]}\n"
              "right_from_left: [1,0,0,-0.1, 0,1,0,0.1, 0,0,1,0, 0,0,0,1]\n",
       "c.yaml:6: right_from_left: expected a motion along -x"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(MessageOf([&] { ParseCamera(c.yaml, "c.yaml"); }), HasSubstr(c.message)) << c.yaml;
  }
}

TEST(FindCamera, KnowsTheBuiltInCameras) {
  EXPECT_THAT(BuiltInCameras(), ElementsAre("icl_nuim", "tum_fr1", "tum_fr2", "tum_fr3"));
  for (const std::string& name : BuiltInCameras()) {
    const Calibration c = FindCamera(name);
    EXPECT_EQ(c.left.width(), 640) << name;
    EXPECT_EQ(c.rate_hz, 30) << name;
    EXPECT_EQ(c.depth_factor, 5000) << name;
  }
  EXPECT_EQ(FindCamera("tum_fr1").left.intrinsics().fx, 517.306408);
  EXPECT_EQ(FindCamera("icl_nuim").left.intrinsics().fy, 480);
  EXPECT_THAT(MessageOf([] { FindCamera("tum_fr4"); }),
              HasSubstr("tum_fr4: no such camera file; built-in cameras: icl_nuim, tum_fr1"));
}

TEST(FindCamera, ReadsAFile) {
  const ScratchFolder folder;
  EXPECT_EQ(FindCamera(folder.Write("my.yaml", kMono).string()).left.intrinsics().fx, 500);
}

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
      "rate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [1, 1, 1, 1]\n"
      "distortion_model: equidistant\ndistortion_coefficients: [0, 0, 0, 0]\n";
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    return MessageOf([&] { ReadEurocSensor(folder.Write("sensor.yaml", text)); });
  };
  EXPECT_EQ(message("", ""), "no error");
  EXPECT_THAT(message("pinhole", "omni"),
              HasSubstr("sensor.yaml:7: camera_model: expected pinhole"));
  EXPECT_THAT(message("equidistant", "fov"),
              HasSubstr("sensor.yaml:9: distortion_model: expected"));
  EXPECT_THAT(message("T_BS", "T_SB"), HasSubstr("T_BS: expected a group of keys"));
  EXPECT_THAT(message("0,0,0,1]", "0,0,0]"), HasSubstr("T_BS.data: expected 16 numbers, found 15"));
  EXPECT_THAT(message("rate_hz: 20\n", ""), HasSubstr("rate_hz: expected a value, found none"));
}

}  // namespace
}  // namespace plumbline
