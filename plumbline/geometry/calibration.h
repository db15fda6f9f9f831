// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace plumbline {

// Model of the sensor. `right` makes it a stereo pair, else `depth_factor` makes it an RGB-D
// camera, else it is a single camera. Each frame must have the images of its kind; other images are
// ignored. To use less than the sensor offers, leave members out.
struct Calibration {
  Camera left;
  std::optional<Camera> right;
  // From the left to the right camera as delivered, before rectification; metres. Only with
  // `right`.
  Rigid3 right_from_left;
  // True if the images are undistorted and, in stereo, corresponding points lie in equal rows.
  bool rectified = false;
  // RGB-D: value of stored depth images per metre. SensorFrame::depth is already in metres.
  std::optional<double> depth_factor;
  // Nominal frames per second. Required for folders of images, which have no times.
  std::optional<double> rate_hz;
  // Widest view of the pinhole images that are cut out of the lens, across and down, in degrees.
  // nullopt: chosen by the lens (rectify.h).
  std::optional<double> view_angle_deg;
  // body: the frame of the ground truth, if it is not the camera's.
  std::optional<Rigid3> body_from_left;
};

// Generous limits of calibrations of real sensors. Numbers beyond them are mistakes in a file (a
// missing decimal point, other units, keys exchanged), and would overflow or give meaningless
// results later. All limits are here and in calibration.cc, so that they are the same for every
// file format. The reader of a file says where in it a number is.
//
// Each function returns what was expected and what was found, "expected rate_hz from 0.0001 to
// 100000 Hz, found 1e+300", or nullopt if nothing is wrong. NaN is always wrong.

constexpr int kLongestSide = 100'000;              // pixels
constexpr std::int64_t kMostPixels = 100'000'000;  // pixels that an image may have

// Checks a width and height in pixels, which need not be whole numbers.
std::optional<std::string> SizeFault(double width, double height);

// Checks focal lengths and principal point against the size of the image, which must have passed
// SizeFault. `number`, if not null, becomes the index among fx, fy, cx, cy of the first wrong
// number.
std::optional<std::string> IntrinsicsFault(const CameraIntrinsics& intrinsics,
                                           std::size_t* number = nullptr);

// Checks that the lens model has a ray for at least half of the image. The intrinsics must have
// passed IntrinsicsFault. O(1).
std::optional<std::string> DistortionFault(const CameraIntrinsics& intrinsics);

// Checks the cameras of a calibration with `right`. The right camera must stand to the right of the
// left one, at a baseline of 0.1 mm to 1 km, face nearly the same direction, have
// images of the same size and, if these are declared rectified, no relative rotation.
std::optional<std::string> PairFault(const Calibration& calibration);

// Checks a whole calibration: sizes, intrinsics and lenses of its cameras, their relative pose, and
// the depth factor. It is for calibrations made by a program, which no reader of files has checked.
std::optional<std::string> CalibrationFault(const Calibration& calibration);

// Checks the view angle of a calibration, if it has one: 10 to 150 degrees.
std::optional<std::string> ViewAngleFault(const Calibration& calibration);

// Checks that images that are declared rectified have no distortion.
std::optional<std::string> RectifiedFault(const Calibration& calibration);

// Checks the frames per second.
std::optional<std::string> RateFault(double rate_hz);
// Checks the value of stored depth images per metre.
std::optional<std::string> DepthFactorFault(double depth_factor);
// Checks the translation between the camera and the body of the ground truth.
std::optional<std::string> LeverFault(const Rigid3& body_from_left);

}  // namespace plumbline
