// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"

#include <filesystem>
#include <string>
#include <vector>

namespace plumbline {

// Reads a camera file:
//
//   model: pinhole
//   size: [752, 480]                            # width, height
//   intrinsics: [458.65, 457.3, 367.2, 248.4]   # fx, fy, cx, cy
//   distortion: radtan                          # none (default) | radtan | equidistant
//   distortion_coefficients: [-0.28, 0.07, 0.0002, 0.00002]
//   rectified: false                            # default
//   rate_hz: 20                                 # optional
//   depth_factor: 5000                          # RGB-D: value of the depth image per metre
//   right:                                      # stereo: the five camera keys as above
//     ...
//   right_from_left: [16 numbers]               # 4x4, row by row; or for a rectified pair:
//   baseline: 0.11                              # metres
//   body_from_left: [16 numbers]                # optional, body = frame of the ground truth
//
// Throws InputError "path:line: key: expected ..., found ...".
Calibration ReadCameraFile(const std::filesystem::path& path);
Calibration ParseCamera(const std::string& yaml, const std::string& source);

// The same for a path or, where there is no such file, the name of a built-in camera.
Calibration FindCamera(const std::string& path_or_name);

// Names of the camera files of configs/cameras, which are part of the program.
std::vector<std::string> BuiltInCameras();

// What a EuRoC sensor.yaml says of one camera.
struct EurocSensor {
  Camera camera;
  Rigid3 body_from_camera;  // T_BS
  double rate_hz = 0;
};
EurocSensor ReadEurocSensor(const std::filesystem::path& path);

// A calibration as a camera file; ParseCamera of it gives the same numbers.
std::string FormatCamera(const Calibration& calibration);

}  // namespace plumbline
