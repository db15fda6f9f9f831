// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Reads a camera file:
//
//   model: pinhole
//   size: [752, 480]                            # width, height
//   intrinsics: [458.65, 457.3, 367.2, 248.4]   # fx, fy, cx, cy
//   distortion: radtan                          # none (default) or another of kDistortionForms
//   distortion_coefficients: [-0.28, 0.07, 0.0002, 0.00002]
//   rectified: false                            # default
//   rate_hz: 20                                 # optional
//   depth_factor: 5000                          # RGB-D: value of the depth image per metre
//   right:                                      # stereo: the five camera keys as above
//     ...
//   right_from_left: [16 numbers]               # 4x4, row by row; or for a rectified pair:
//   baseline: 0.11                              # metres
//   body_from_left: [16 numbers]                # optional, body = frame of the ground truth
//   imu:                                        # optional, see inertial_calibration_file.h
//
// or a file of another program, recognized by its keys: EuRoC's sensor.yaml (one camera), Kalibr's
// camchain.yaml, settings of ORB-SLAM2 and 3 and of stella_vslam, Basalt's and CamOdoCal's files,
// COLMAP's cameras.txt, and calibrations by OpenCV's programs or ROS (all in camera_formats.h).
//
// Throws InputError "source:line: key: expected ..., found ...".
//
// Implausible numbers (geometry/calibration.h) are refused, those of the second camera only if
// `use_pair`.
Calibration ParseCamera(const std::string& yaml, const std::string& source, bool use_pair = true);

// A calibration and a description of its origin, for people: "rig/camchain.yaml (Kalibr camchain)".
struct CameraFile {
  Calibration calibration;
  std::string source;
};
// Reads the file at a path; see ParseCamera for errors.
CameraFile ReadCameraFile(const std::filesystem::path& path, bool use_pair = true);

// Reads the file at a path or, if there is none or a folder, the built-in camera of that name.
// Throws InputError with the names of the built-in cameras if there is neither.
CameraFile FindCamera(const std::string& path_or_name, bool use_pair = true);

// Returns the camera file in an image folder: camera.yaml or camchain.yaml, of any format.
std::optional<std::filesystem::path> CameraFileIn(const std::filesystem::path& folder);

// Returns the names of the camera files of configs/cameras, which are part of the program.
std::vector<std::string> BuiltInCameras();

// Returns a calibration as a camera file; ParseCamera restores the same numbers.
std::string FormatCamera(const Calibration& calibration);

}  // namespace plumbline
