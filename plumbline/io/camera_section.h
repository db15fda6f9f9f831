// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/io/yaml_section.h"

#include <string>

namespace plumbline {

// What the formats of camera files have in common.

// Keys of a camera whose numbers stand in lists: [width, height], [fx, fy, cx, cy], [k1, ...].
struct CameraListKeys {
  std::string size;
  std::string intrinsics;
  std::string coefficients;
};

// Such a camera; the coefficients are read only where the model has any. InputError naming the key.
Camera ReadListedCamera(const YamlSection& section,
                        const CameraListKeys& keys,
                        DistortionModel model);

// The camera of a section with `camera_model` (pinhole) and `distortion_model` (`radtan_name`,
// equidistant or none), as EuRoC and Kalibr write it. InputError naming the key.
Camera ReadModelCamera(const YamlSection& section,
                       const CameraListKeys& keys,
                       const std::string& radtan_name);

// Fails unless the text of `key` is pinhole.
void CheckPinhole(const YamlSection& section, const std::string& key);

// Camera(intrinsics), its errors as those of `key`.
Camera CheckedCamera(const YamlSection& section,
                     const std::string& key,
                     const CameraIntrinsics& intrinsics);

// A width or height as `key` gives it: InputError unless it is a whole number from 1 to 100000.
int CheckedLength(const YamlSection& section, const std::string& key, double length);

// Fails at `key` unless `right_from_left` is that of a rectified pair: a motion along -x.
void CheckRectifiedPair(const YamlSection& section,
                        const std::string& key,
                        const Rigid3& right_from_left);

}  // namespace plumbline
