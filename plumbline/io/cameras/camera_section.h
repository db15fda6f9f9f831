// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/cameras/yaml_section.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// Functions common to the formats of camera files.

// Keys of a camera with lists of numbers: [width, height], [fx, fy, cx, cy], [k1, ...]. Without
// `coefficients` they are zero.
struct CameraListKeys {
  std::string size;
  std::string intrinsics;
  std::string coefficients;
};

// Reads a camera with these keys; the coefficients are read only if the model has any. Where the
// list of intrinsics starts with numbers of the model (Kalibr: xi, alpha, fx, ...), `leading` says
// how many. InputError names the key.
Camera ReadListedCamera(const YamlSection& section,
                        const CameraListKeys& keys,
                        DistortionModel model,
                        std::size_t leading = 0);

// Reads the camera of a section with `camera_model` (pinhole) and `distortion_model`
// (`radtan_name`, equidistant, fov or none), as in files of EuRoC and Kalibr. InputError names the
// key.
Camera ReadModelCamera(const YamlSection& section,
                       const CameraListKeys& keys,
                       const std::string& radtan_name);

// Fails unless the text of `key` is pinhole.
void CheckPinhole(const YamlSection& section, const std::string& key);

// Keys of a camera whose intrinsics have keys of their own, or all the same one.
struct CameraKeys {
  std::string size;
  std::array<std::string, 4> intrinsics;  // keys of fx, fy, cx, cy
  std::string coefficients;
};

// Returns Camera(intrinsics) if the numbers are plausible (geometry/calibration.h). Otherwise
// throws InputError at the key of the size, of the first implausible intrinsic, or of the
// coefficients.
Camera CheckedCamera(const YamlSection& section,
                     const CameraKeys& keys,
                     const CameraIntrinsics& intrinsics);

// Returns a width or height that `key` gives; throws InputError unless it is a whole number of
// pixels.
int CheckedLength(const YamlSection& section, const std::string& key, double length);
// Reads a width or height. Throws InputError if it is missing or no whole number of pixels.
int ReadLength(const YamlSection& section, const std::string& key);

// Reads fx, fy, cx and cy from the 3x3 matrix at `key`. Throws InputError if it has skew.
void ReadCameraMatrix(const YamlSection& section,
                      const std::string& key,
                      CameraIntrinsics& intrinsics);

// Sets the distortion to the coefficients k1, k2, p1, p2 and, if given, k3; to none if all are 0.
void SetRadTan(const std::vector<double>& coefficients, CameraIntrinsics& intrinsics);

// Sets the distortion to coefficients in the order of OpenCV: k1, k2, p1, p2, k3, k4, k5, k6, then
// those of the thin prism and tilted models, which must be zero. It is rational if any of k4 to k6
// is not zero, radtan otherwise, and none if all are zero. Returns the reason if they cannot be
// used, "expected ..., found ...".
std::optional<std::string> SetOpenCvDistortion(std::span<const double> coefficients,
                                               CameraIntrinsics& intrinsics);

// Keys of the numbers of a calibration in a file format: for each the possible keys, of which a
// file has one. "cam1/T_cn_cnm1" is a key of a group.
struct CalibrationKeys {
  std::vector<std::string> pair, rate, depth_factor, lever;
};

// Fails at the key of the first implausible number (geometry/calibration.h). The pair is checked
// only if it is used: even a rig without a usable pair has a usable left camera.
void CheckCalibration(const YamlSection& root,
                      const CalibrationKeys& keys,
                      const Calibration& calibration,
                      bool use_pair);

// Fails at `key` unless `right_from_left` is the motion of a rectified pair: along -x.
void CheckRectifiedPair(const YamlSection& section,
                        const std::string& key,
                        const Rigid3& right_from_left);

}  // namespace plumbline
