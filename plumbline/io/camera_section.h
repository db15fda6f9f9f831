// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/yaml_section.h"

#include <array>
#include <string>
#include <vector>

namespace plumbline {

// Functions that the formats of camera files have in common.

// The keys of a camera whose numbers stand in lists: [width, height], [fx, fy, cx, cy], [k1, ...].
struct CameraListKeys {
  std::string size;
  std::string intrinsics;
  std::string coefficients;
};

// Reads a camera by such keys; the coefficients are read only where the model has any. InputError
// names the key.
Camera ReadListedCamera(const YamlSection& section,
                        const CameraListKeys& keys,
                        DistortionModel model);

// Reads the camera of a section with `camera_model` (pinhole) and `distortion_model`
// (`radtan_name`, equidistant or none), as EuRoC and Kalibr write it. InputError names the key.
Camera ReadModelCamera(const YamlSection& section,
                       const CameraListKeys& keys,
                       const std::string& radtan_name);

// Fails unless the text of `key` is pinhole.
void CheckPinhole(const YamlSection& section, const std::string& key);

// The keys of a camera whose intrinsics stand at keys of their own, or all at the same one.
struct CameraKeys {
  std::string size;
  std::array<std::string, 4> intrinsics;  // keys of fx, fy, cx, cy
  std::string coefficients;
};

// Returns Camera(intrinsics) where the numbers can be those of a camera (plausible_calibration.h).
// Throws InputError at the key of the size, of the first intrinsic at fault, or otherwise of the
// coefficients.
Camera CheckedCamera(const YamlSection& section,
                     const CameraKeys& keys,
                     const CameraIntrinsics& intrinsics);

// Reads a width or height. Throws InputError unless the file has it and it is a whole number of
// pixels.
int ReadLength(const YamlSection& section, const std::string& key);

// Reads fx, fy, cx and cy from the 3x3 matrix at `key`. Throws InputError unless it has no skew.
void ReadCameraMatrix(const YamlSection& section,
                      const std::string& key,
                      CameraIntrinsics& intrinsics);

// Sets the distortion to these coefficients k1, k2, p1, p2 and, where there is a fifth, k3; to none
// where all are 0.
void SetRadTan(const std::vector<double>& coefficients, CameraIntrinsics& intrinsics);

// Where a file of some format has the numbers of a calibration: for each the keys at which it may
// stand, of which the file has one. "cam1/T_cn_cnm1" is a key of a group.
struct CalibrationKeys {
  std::vector<std::string> pair, rate, depth_factor, lever;
};

// Fails at the key of the first number that no real sensor has (plausible_calibration.h). The pair
// is checked only where it is to be used: even a rig that is not a pair of our kind has a usable
// left camera.
void CheckCalibration(const YamlSection& root,
                      const CalibrationKeys& keys,
                      const Calibration& calibration,
                      bool use_pair);

// Fails at `key` unless `right_from_left` is the motion of a rectified pair: along -x.
void CheckRectifiedPair(const YamlSection& section,
                        const std::string& key,
                        const Rigid3& right_from_left);

}  // namespace plumbline
