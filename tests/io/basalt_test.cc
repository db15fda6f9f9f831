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
namespace basalt_test {

using testing::HasSubstr;

// Two cameras 0.1 m apart, of which the second is turned by 2 atan(0.01) about y; the sensor's
// frame is turned by a right angle about z.
std::string Rig(const std::string& left, const std::string& right) {
  return R"({
    "value0": {
        "T_imu_cam": [
            {"px": 0.02, "py": 0.03, "pz": 0.04,
             "qx": 0.0, "qy": 0.0, "qz": 0.7071067811865476, "qw": 0.7071067811865476},
            {"px": 0.02, "py": 0.13, "pz": 0.04,
             "qx": 0.0, "qy": 0.0, "qz": 0.7071067811865476, "qw": 0.7071067811865476}
        ],
        "intrinsics": [
            {"camera_type": )" +
         left + R"(},
            {"camera_type": )" +
         right + R"(}
        ],
        "resolution": [
            [640, 480],
            [640, 480]
        ],
        "vignette": [],
        "calib_accel_bias": [0.0, 0.0, 0.0],
        "imu_update_rate": 200.0
    }
}
)";
}

std::string Lens(const std::string& type, const std::string& numbers) {
  return "\"" + type +
         "\", \"intrinsics\": {\"fx\": 300.5, \"fy\": 301.5, \"cx\": 318, \"cy\": 242" + numbers +
         "}";
}

CameraIntrinsics LeftOf(const std::string& type, const std::string& numbers) {
  return ParseCamera(Rig(Lens(type, numbers), Lens("pinhole", "")), "calibration.json")
      .left.intrinsics();
}

TEST(ReadBasalt, ReadsEveryTypeOfCamera) {
  using enum DistortionModel;
  CameraIntrinsics expected{
      .fx = 300.5, .fy = 301.5, .cx = 318, .cy = 242, .width = 640, .height = 480};
  EXPECT_EQ(LeftOf("pinhole", ""), expected);
  const auto of = [&](DistortionModel model, std::array<double, kMostCoefficients> numbers) {
    expected.model = model;
    expected.distortion = numbers;
    return expected;
  };
  EXPECT_EQ(LeftOf("kb4", ", \"k1\": 0.1, \"k2\": -0.02, \"k3\": 0.003, \"k4\": -0.0004"),
            of(kEquidistant, {0.1, -0.02, 0.003, -0.0004}));
  EXPECT_EQ(LeftOf("ds", ", \"xi\": -0.2, \"alpha\": 0.57"), of(kDoubleSphere, {-0.2, 0.57}));
  EXPECT_EQ(LeftOf("eucm", ", \"alpha\": 0.6, \"beta\": 1.1"), of(kEucm, {0.6, 1.1}));
  EXPECT_EQ(LeftOf("ucm", ", \"alpha\": 0.6"), of(kEucm, {0.6, 1}));
  EXPECT_EQ(LeftOf("fov", ", \"w\": 0.9"), of(kFov, {0.9}));
  EXPECT_EQ(LeftOf("pinhole-radtan8",
                   ", \"k1\": 0.3, \"k2\": -0.02, \"p1\": 0.001, \"p2\": 0.002, \"k3\": 0.01, "
                   "\"k4\": 0.5, \"k5\": -0.06, \"k6\": 0.03, \"rpmax\": 2.7"),
            of(kRational, {0.3, -0.02, 0.001, 0.002, 0.01, 0.5, -0.06, 0.03}));
}

TEST(ReadBasalt, ThePairFollowsFromThePosesAtTheInertialSensor) {
  const Calibration c =
      ParseCamera(Rig(Lens("pinhole", ""), Lens("pinhole", "")), "calibration.json");
  ASSERT_TRUE(c.right);
  // y of the sensor is x of the cameras.
  EXPECT_LT((c.right_from_left.translation - Eigen::Vector3d(-0.1, 0, 0)).norm(), 1e-12);
  EXPECT_LT(c.right_from_left.rotation.vec().norm(), 1e-12);
  EXPECT_FALSE(c.rectified);
}

// Quaternions with few digits are off by more than rounding.
TEST(ReadBasalt, QuaternionsAreNormalized) {
  std::string text = Rig(Lens("pinhole", ""), Lens("pinhole", ""));
  for (const char* key : {"\"qz\": ", "\"qw\": "}) {
    const std::string exact = key + std::string("0.7071067811865476");
    for (std::size_t at = 0; (at = text.find(exact, at)) != std::string::npos;) {
      text.replace(at, exact.size(), key + std::string("0.71"));
    }
  }
  const Calibration c = ParseCamera(text, "calibration.json");
  EXPECT_LT((c.right_from_left.translation - Eigen::Vector3d(-0.1, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(c.right_from_left.rotation.norm(), 1, 1e-12);
}

TEST(ReadBasalt, SaysWhatIsWrong) {
  const auto message = [](const std::string& left, const std::string& from, const std::string& to) {
    std::string text = Rig(left, Lens("pinhole", ""));
    text.replace(text.find(from), from.size(), to);
    return MessageOf([&] { ParseCamera(text, "calibration.json"); });
  };
  const std::string pinhole = Lens("pinhole", ""), none = "value0";
  EXPECT_EQ(message(Lens("ftheta", ""), none, none),
            "calibration.json:10: value0.intrinsics[0].camera_type: expected pinhole, "
            "pinhole-radtan8, kb4, ds, eucm, ucm or fov, found 'ftheta'");
  EXPECT_THAT(message(Lens("ds", ", \"xi\": 0.1"), none, none),
              HasSubstr("calibration.json:10: value0.intrinsics[0].intrinsics.alpha: expected"));
  EXPECT_THAT(message(Lens("ds", ", \"xi\": 0.1, \"alpha\": 7"), none, none),
              HasSubstr("calibration.json:10: value0.intrinsics[0].intrinsics.alpha: "
                        "double_sphere: expected alpha "
                        "from 0 to 1, found 7"));
  EXPECT_THAT(message(pinhole, "[640, 480],", ""), HasSubstr("value0.resolution: expected 2 rows"));
  EXPECT_THAT(message(pinhole, "0.13", "-0.13"), HasSubstr("T_imu_cam: expected the right camera"));
  EXPECT_THAT(message(pinhole, "\"qw\": 0.7071067811865476", "\"qw\": 0.9"),
              HasSubstr("value0.T_imu_cam[0].qw: expected qx, qy, qz, qw of a rotation"));
}

}  // namespace basalt_test
}  // namespace plumbline
