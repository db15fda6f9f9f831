// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/yaml_section.h"

namespace plumbline {

// Reads a camchain.yaml as the calibration tool Kalibr writes it: cam0 becomes the left camera,
// cam1, where there is one, the right camera with right_from_left = T_cn_cnm1, or where there is
// none (OpenVINS) what follows from T_cam_imu or T_imu_cam of both. Further cameras, the place of
// an inertial sensor otherwise, time shifts and topics do not matter here. Models: pinhole with
// radtan, equidistant or no distortion. rate_hz and depth_factor, which Kalibr does not write, may
// be added at the top or to cam0. Throws InputError naming the key for others.
Calibration ReadKalibr(const YamlSection& root);

}  // namespace plumbline
