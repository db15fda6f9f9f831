// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/yaml_section.h"

namespace plumbline {

// Reads a camchain.yaml of the calibration tool Kalibr: cam0 becomes the left camera, cam1, if any,
// the right camera with right_from_left = T_cn_cnm1, or without it (OpenVINS) from T_cam_imu or
// T_imu_cam of both. Further cameras, other extrinsics of an inertial sensor, time shifts and
// topics are ignored. Models: pinhole with radtan, equidistant or no distortion. rate_hz and
// depth_factor, which Kalibr does not write, may be added at the top or to cam0. Throws InputError
// naming the key for others.
Calibration ReadKalibr(const YamlSection& root);

}  // namespace plumbline
