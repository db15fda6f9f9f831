// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/recording/image_message.h"

#include <optional>
#include <string>

namespace plumbline {

// The camera info of one camera, with its name.
struct RecordedCamera {
  CalibrationMessage message;
  std::string source;      // "drive.bag: /cam0/camera_info"
  bool rectified = false;  // its images are rectified: their camera is P, not K and D
};

// Whether the camera was calibrated. Drivers send zeros if not.
bool IsCalibrated(const CalibrationMessage& message);

// Returns the calibration that sensor_msgs/CameraInfo (or foxglove.CameraCalibration) describes,
// with a distortion that SetNamedDistortion knows. In a pair, R turns each camera into the
// rectified pair and P of the right one has the baseline: -P[3] / P[0], metres.
//
// Throws InputError "source: ..." for other models, binned or cut images, a pair in which only one
// camera has rectified images or P has no baseline, and numbers that no camera has.
Calibration CalibrationOf(const RecordedCamera& left, const std::optional<RecordedCamera>& right);

}  // namespace plumbline
