// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/calibration.h"

#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {

namespace {

using testing::HasSubstr;
using testing::Optional;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

CameraIntrinsics Intrinsics() {
  return {.fx = 458.654,
          .fy = 457.296,
          .cx = 367.215,
          .cy = 248.375,
          .width = 752,
          .height = 480,
          .model = DistortionModel::kRadTan,
          .distortion = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0}};
}

// A pair whose right camera stands at `centre` in the left one.
Calibration Pair(const Eigen::Vector3d& centre,
                 const Eigen::Quaterniond& right_from_left = Eigen::Quaterniond::Identity()) {
  Calibration calibration;
  calibration.left = Camera(Intrinsics());
  calibration.right = calibration.left;
  calibration.right_from_left = {right_from_left, -(right_from_left * centre)};
  return calibration;
}

Eigen::Quaterniond Turn(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis));
}

TEST(SizeFault, TakesImagesOnly) {
  EXPECT_EQ(SizeFault(752, 480), std::nullopt);
  EXPECT_EQ(SizeFault(1, 1), std::nullopt);
  EXPECT_EQ(SizeFault(10'000, 10'000), std::nullopt);
  for (const double length : {0.0, -1.0, 0.5, 100'001.0, 1e300, kNan, kInfinity}) {
    EXPECT_THAT(SizeFault(length, 480), Optional(HasSubstr("expected whole numbers from 1 to ")));
    EXPECT_THAT(SizeFault(752, length), Optional(HasSubstr("expected whole numbers from 1 to ")));
  }
  EXPECT_EQ(SizeFault(30'000, 30'000),
            "expected an image of at most 100 million pixels, found one of 30000x30000");
}

TEST(IntrinsicsFault, TakesRealCamerasOnly) {
  EXPECT_EQ(IntrinsicsFault(Intrinsics()), std::nullopt);
  CameraIntrinsics wide = Intrinsics();
  wide.fx = wide.fy = 100;  // 150 degrees of a fisheye lens
  EXPECT_EQ(IntrinsicsFault(wide), std::nullopt);
  CameraIntrinsics narrow = Intrinsics();
  narrow.fx = narrow.fy = 500'000;  // a telescope
  EXPECT_EQ(IntrinsicsFault(narrow), std::nullopt);
  for (const double value : {-458.0, 0.0, 1e-300, 1.0, 1e9, 1e300, kNan, kInfinity}) {
    CameraIntrinsics in = Intrinsics();
    in.fx = value;
    EXPECT_THAT(IntrinsicsFault(in),
                Optional(HasSubstr("expected fx from 7.52 to 752000 px, found ")));
    in = Intrinsics();
    in.fy = value;
    EXPECT_THAT(IntrinsicsFault(in),
                Optional(HasSubstr("expected fy from 7.52 to 752000 px, found ")));
  }
  for (const double value : {-1e5, 1e5, 1e300, kNan, -kInfinity}) {
    CameraIntrinsics in = Intrinsics();
    in.cx = value;
    EXPECT_THAT(IntrinsicsFault(in), Optional(HasSubstr("expected cx from -7520 to 8272 px")));
    in = Intrinsics();
    in.cy = value;
    EXPECT_THAT(IntrinsicsFault(in), Optional(HasSubstr("expected cy from -7520 to 8272 px")));
  }
  for (const double value : {1e300, -1e7, kNan}) {
    CameraIntrinsics in = Intrinsics();
    in.distortion[4] = value;
    EXPECT_THAT(DistortionFault(in), Optional(HasSubstr("expected coefficients from -1e+06 to ")));
  }
}

TEST(IntrinsicsFault, TellsWhichNumberIsAtFault) {
  const std::vector<double CameraIntrinsics::*> numbers = {
      &CameraIntrinsics::fx, &CameraIntrinsics::fy, &CameraIntrinsics::cx, &CameraIntrinsics::cy};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    CameraIntrinsics in = Intrinsics();
    for (std::size_t k = i; k < numbers.size(); ++k) in.*numbers[k] = 1e9;
    std::size_t number = numbers.size();
    EXPECT_TRUE(IntrinsicsFault(in, &number));
    EXPECT_EQ(number, i);
  }
}

TEST(DistortionFault, TheImageHasRays) {
  EXPECT_EQ(DistortionFault(Intrinsics()), std::nullopt);
  CameraIntrinsics in = Intrinsics();
  in.model = DistortionModel::kEquidistant;
  in.distortion = {0.0034, 0.0007, -0.002, 0.0002, 0};
  EXPECT_EQ(DistortionFault(in), std::nullopt);
  in.model = DistortionModel::kNone;
  EXPECT_EQ(DistortionFault(in), std::nullopt);
  // Coefficients of another scale, such as those of pixels, bend all rays back near the axis.
  for (const double k : {-30.0, -1e5}) {
    in = Intrinsics();
    in.distortion[0] = k;
    EXPECT_THAT(DistortionFault(in), Optional(HasSubstr("expected a distortion that has a ray")))
        << k;
  }
}

TEST(DistortionFault, KeepsToTheBoundsOfTheModel) {
  CameraIntrinsics in = Intrinsics();
  in.model = DistortionModel::kDoubleSphere;
  in.distortion = {0.1, 1.5};
  EXPECT_THAT(DistortionFault(in),
              Optional(std::string("double_sphere: expected alpha from 0 to 1, found 1.5")));
  in.model = DistortionModel::kOmni;
  in.distortion = {1.2, -0.1};
  EXPECT_EQ(DistortionFault(in), std::nullopt);
}

TEST(PairFault, TheRightCameraIsOnTheRight) {
  EXPECT_EQ(PairFault(Pair({0.11, 0.001, -0.002}, Turn(1, {0, 1, 0}))), std::nullopt);
  EXPECT_EQ(PairFault(Pair({0.004, 0, 0})), std::nullopt);
  EXPECT_EQ(PairFault(Pair({0.11, 0, 0}, Turn(60, {0, 1, 0}))), std::nullopt);
  const std::vector<Eigen::Vector3d> wrong = {
      {0, 0, 0}, {-0.11, 0, 0}, {0, 0.11, 0}, {0.01, 0, 0.11}, {kNan, 0, 0}};
  for (const Eigen::Vector3d& centre : wrong) {
    EXPECT_THAT(PairFault(Pair(centre)),
                Optional(HasSubstr("expected the right camera to the right (+x) of the left one")));
  }
  for (const double baseline : {1e-9, 1e-5, 1e4, 1e30}) {
    EXPECT_THAT(PairFault(Pair({baseline, 0, 0})),
                Optional(HasSubstr("expected a baseline from 0.0001 to 1000 m, found ")));
  }
  EXPECT_EQ(PairFault(Pair({0.11, 0, 0}, Turn(180, {0, 1, 0}))),
            "expected a right camera that looks the way the left one does, found its axis 180 "
            "degrees off");
}

TEST(PairFault, ImagesAreAlike) {
  Calibration calibration = Pair({0.11, 0, 0});
  CameraIntrinsics other = Intrinsics();
  other.width = 640;
  calibration.right = Camera(other);
  EXPECT_EQ(PairFault(calibration),
            "expected a right camera of 752x480 pixels like the left one, found 640x480");
  calibration = Pair({0.11, 0, 0}, Turn(1, {0, 0, 1}));
  EXPECT_EQ(PairFault(calibration), std::nullopt);
  calibration.rectified = true;
  EXPECT_THAT(PairFault(calibration),
              Optional(HasSubstr("declared rectified, found a turn of 0.0174")));
}

TEST(RateFault, LeavesRoomForStamps) {
  for (const double rate : {1e-4, 1.0 / 60, 20.0, 1000.0, 1e5})
    EXPECT_EQ(RateFault(rate), std::nullopt);
  for (const double rate : {0.0, -20.0, 1e-300, 1e300, kNan, kInfinity}) {
    EXPECT_THAT(RateFault(rate), Optional(HasSubstr("expected a rate from 0.0001 to 100000 Hz")));
  }
}

TEST(DepthFactorFault, IsThatOfSomeUnit) {
  for (const double factor : {1.0, 1000.0, 5000.0, 1e6})
    EXPECT_EQ(DepthFactorFault(factor), std::nullopt);
  for (const double factor : {0.0, -1.0, 1e-300, 1e300, kNan}) {
    EXPECT_THAT(DepthFactorFault(factor),
                Optional(HasSubstr("expected a depth factor from 0.001 to")));
  }
}

TEST(LeverFault, TheCameraIsOnTheBody) {
  EXPECT_EQ(LeverFault({Eigen::Quaterniond::Identity(), {1, 2, 3}}), std::nullopt);
  EXPECT_THAT(LeverFault({Eigen::Quaterniond::Identity(), {1e300, 0, 0}}),
              Optional(HasSubstr("expected a body at most 10000 m from the camera, found ")));
}

TEST(CalibrationFault, NamesTheCamera) {
  Calibration calibration = Pair({0.1, 0, 0});
  EXPECT_EQ(CalibrationFault(calibration), std::nullopt);
  CameraIntrinsics short_focal = Intrinsics();
  short_focal.fx = 0.4;
  calibration.right = Camera(short_focal);
  EXPECT_THAT(CalibrationFault(calibration), Optional(HasSubstr("right camera: expected fx from")));
  calibration.left = Camera(short_focal);
  EXPECT_THAT(CalibrationFault(calibration), Optional(HasSubstr("left camera: expected fx from")));
  EXPECT_THAT(CalibrationFault(Pair({-0.1, 0, 0})), Optional(HasSubstr("to the right")));
  calibration = Pair({0.1, 0, 0});
  calibration.rectified = true;
  EXPECT_THAT(CalibrationFault(calibration), Optional(HasSubstr("no lens distortion")));
  calibration.rectified = false;
  calibration.depth_factor = 0;
  EXPECT_THAT(CalibrationFault(calibration), Optional(HasSubstr("a depth factor")));
}

}  // namespace

}  // namespace plumbline
