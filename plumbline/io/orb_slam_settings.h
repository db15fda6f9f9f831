// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/yaml_section.h"

namespace plumbline {

// Reads the camera from a settings file of ORB-SLAM2 or ORB-SLAM3, in the form with and without
// `File.version: "1.0"`; all other settings are ignored. Sensors by keys:
//
//   LEFT.K, .D, .R, .P, RIGHT.*  a raw stereo pair with its rectification: x_rect = R x and
//                                P_right = K [I | t] give right_from_left =
//                                (R_right^T R_left, R_right^T t)
//   Camera2.*                    a raw stereo pair, right_from_left = (Stereo.T_c1_c2)^-1, in
//                                older files Tlr^-1: the pose of camera 2 in camera 1
//   DepthMapFactor, RGBD.DepthMapFactor
//                                colour and depth; bf and b are of no real camera then
//   Camera.bf, Stereo.b          a rectified stereo pair of baseline bf / fx, or b
//   none of these                one camera
//
// Camera.type: PinHole (k1 k2 p1 p2 [k3]), KannalaBrandt8 (k1 k2 k3 k4) or Rectified. Throws
// InputError naming the key; the image size is required, as images are checked against it.
Calibration ReadOrbSlamSettings(const YamlSection& root);

}  // namespace plumbline
