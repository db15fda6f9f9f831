// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/camera.h"
#include "plumbline/io/recordings/image_message.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// The camera info of one camera, with its name.
struct RecordedCamera {
  CalibrationMessage message;
  std::string source;      // "drive.bag: /cam0/camera_info"
  bool rectified = false;  // true if its images are rectified: their camera is P, not K and D
};

// Returns true if the camera was calibrated. Drivers send zeros if not.
bool IsCalibrated(const CalibrationMessage& message);

// Returns the calibration of a sensor_msgs/CameraInfo (or foxglove.CameraCalibration), with a
// distortion known to SetNamedDistortion. In a pair, R rotates each camera into the rectified pair
// and P of the right one has the baseline: -P[3] / P[0], metres.
//
// Throws InputError "source: ..." for other models, binned or cropped images, a pair in which only
// one camera has rectified images or P has no baseline, and implausible numbers.
Calibration CalibrationOf(const RecordedCamera& left, const std::optional<RecordedCamera>& right);

// Sets the distortion of a camera from the name of a model as written by ROS, OpenCV, Foxglove and
// drivers of cameras, in any case and with blanks or underscores:
//
//   plumb_bob, rational_polynomial, radtan, radial_tangential, Brown Conrady
//                      k1 k2 p1 p2 [k3 [k4 k5 k6]], followed only by zeros: radtan, or rational if
//                      any of k4 to k6 is not zero
//   equidistant, fisheye, Kannala Brandt, kannala_brandt4
//                      k1 k2 k3 k4, followed only by zeros
//   none, "", Inverse Brown Conrady, Modified Brown Conrady, others
//                      no distortion, if there are no numbers or all are 0
//
// Returns the reason if the model cannot be used, as "expected ..., found ...".
std::optional<std::string> SetNamedDistortion(std::string_view model,
                                              std::span<const double> numbers,
                                              CameraIntrinsics& intrinsics);

}  // namespace plumbline
