// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"

#include "tests/io/scratch_folder.h"
#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace colmap_cameras_test {

using testing::HasSubstr;

const std::string kHead =
    "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, "
    "PARAMS[]\n# Number of cameras: 1\n";

Calibration Parse(const std::string& rows) { return ParseCamera(kHead + rows, "cameras.txt"); }

TEST(ReadColmapCameras, ReadsEveryModelButThinPrisms) {
  using enum DistortionModel;
  CameraIntrinsics expected{
      .fx = 500, .fy = 500, .cx = 319.5, .cy = 239.5, .width = 640, .height = 480};
  const auto of = [&](DistortionModel model, std::array<double, kMostCoefficients> numbers) {
    expected.model = model;
    expected.distortion = numbers;
    return expected;
  };
  const auto left = [](const std::string& row) {
    return Parse("1 " + row + "\n").left.intrinsics();
  };
  // The centre of the first pixel is (0.5, 0.5) there.
  EXPECT_EQ(left("SIMPLE_PINHOLE 640 480 500 320 240"), of(kNone, {}));
  EXPECT_EQ(left("SIMPLE_RADIAL 640 480 500 320 240 0.1"), of(kRadTan, {0.1}));
  EXPECT_EQ(left("RADIAL 640 480 500 320 240 0.1 -0.02"), of(kRadTan, {0.1, -0.02}));
  EXPECT_EQ(left("SIMPLE_RADIAL_FISHEYE 640 480 500 320 240 0.1"), of(kEquidistant, {0.1}));
  EXPECT_EQ(left("RADIAL_FISHEYE 640 480 500 320 240 0.1 -0.02"), of(kEquidistant, {0.1, -0.02}));
  expected.fy = 501;
  EXPECT_EQ(left("PINHOLE 640 480 500 501 320 240"), of(kNone, {}));
  EXPECT_EQ(left("OPENCV 640 480 500 501 320 240 0.1 -0.02 0.003 0.004"),
            of(kRadTan, {0.1, -0.02, 0.003, 0.004}));
  EXPECT_EQ(left("FULL_OPENCV 640 480 500 501 320 240 0.1 -0.02 0.003 0.004 0.05 0.2 -0.1 0.01"),
            of(kRational, {0.1, -0.02, 0.003, 0.004, 0.05, 0.2, -0.1, 0.01}));
  EXPECT_EQ(left("OPENCV_FISHEYE 640 480 500 501 320 240 0.1 -0.02 0.003 0.004"),
            of(kEquidistant, {0.1, -0.02, 0.003, 0.004}));
  EXPECT_EQ(left("FOV 640 480 500 501 320 240 0.9"), of(kFov, {0.9}));
}

TEST(ReadColmapCameras, ARateStandsInAComment) {
  EXPECT_FALSE(Parse("1 SIMPLE_PINHOLE 640 480 500 320 240\n").rate_hz);
  EXPECT_EQ(Parse("# rate_hz: 20\n1 SIMPLE_PINHOLE 640 480 500 320 240\n").rate_hz, 20);
  EXPECT_THAT(MessageOf([] { Parse("# rate_hz: x\n1 PINHOLE 640 480 500 500 320 240\n"); }),
              HasSubstr("cameras.txt:4: rate_hz: expected a rate from"));
}

TEST(ReadColmapCameras, IsToldByItsFirstRow) {
  const ScratchFolder folder;
  const std::string path =
      folder.Write("cameras.txt", kHead + "7 PINHOLE 640 480 500 501 320 240\n").string();
  EXPECT_EQ(ReadCameraFile(path).source, path + " (COLMAP cameras.txt)");
}

TEST(ReadColmapCameras, SaysWhatIsWrong) {
  const auto message = [](const std::string& rows) { return MessageOf([&] { Parse(rows); }); };
  EXPECT_EQ(message("1 THIN_PRISM_FISHEYE 640 480 500 501 320 240 0 0 0 0 0 0 0 0\n"),
            "cameras.txt:4: expected one of SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, "
            "OPENCV, FULL_OPENCV, SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE, OPENCV_FISHEYE, FOV, "
            "found 'THIN_PRISM_FISHEYE'");
  EXPECT_EQ(message("1 PINHOLE 640 480 500 320 240\n"),
            "cameras.txt:4: expected 6 numbers behind PINHOLE, found 5");
  EXPECT_THAT(message("1 PINHOLE 640 480 500 501 320 x\n"),
              HasSubstr("cameras.txt:4: expected a number, found 'x'"));
  EXPECT_THAT(message("1 OPENCV width 480 500 501 320 240 0 0 0 0\n"),
              HasSubstr("cameras.txt:4: expected a number, found 'width'"));
  EXPECT_THAT(message("1 PINHOLE 640 480 -5 501 320 240\n"),
              HasSubstr("cameras.txt:4: expected fx from"));
  EXPECT_THAT(message("1 FOV 640 480 500 501 320 240 4\n"),
              HasSubstr("cameras.txt:4: fov: expected w between 0 and pi, found 4"));
  EXPECT_THAT(message("1 PINHOLE 640 480 500 501 320 240\n2 PINHOLE 640 480 500 501 320 240\n"),
              HasSubstr("cameras.txt:5: expected one camera, found another one"));
}

}  // namespace colmap_cameras_test
}  // namespace plumbline
