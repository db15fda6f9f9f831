// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/yaml_section.h"

namespace plumbline {

// Reads the calibration of one camera as written by OpenCV's calibration programs (FileStorage) and
// by ROS's camera_calibration (ost.yaml, the files of camera_info):
//
//   image_width, image_height
//   camera_matrix            3x3 without skew
//   distortion_coefficients  k1 k2 p1 p2 [k3 [zeros]]; of a fisheye k1 k2 k3 k4
//   distortion_model         plumb_bob, rational_polynomial (with zeros behind k3), equidistant or
//                            fisheye; OpenCV's programs have fisheye_model, 0 or 1, in its place
//
// rate_hz and depth_factor, which neither writes, may be added. All other keys are ignored for one
// camera: its name, its rectification for a pair, and the process of its calibration. Throws
// InputError naming the key.
Calibration ReadOpenCvCalibration(const YamlSection& root);

}  // namespace plumbline
