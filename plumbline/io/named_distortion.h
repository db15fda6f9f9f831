// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// Sets the distortion of a camera from the name of a model as ROS, OpenCV, Foxglove and the drivers
// of cameras write it, whatever its case and whether with blanks or underscores:
//
//   plumb_bob, rational_polynomial, radtan, radial_tangential, Brown Conrady
//                      k1 k2 p1 p2 [k3], behind which all numbers are 0
//   equidistant, fisheye, Kannala Brandt, kannala_brandt4
//                      k1 k2 k3 k4, behind which all numbers are 0
//   none, "", Inverse Brown Conrady, Modified Brown Conrady, others
//                      no distortion, where there are no numbers or all are 0
//
// Returns why the model cannot be used, as "expected ..., found ...", where it cannot.
std::optional<std::string> SetNamedDistortion(std::string_view model,
                                              std::span<const double> numbers,
                                              CameraIntrinsics& intrinsics);

}  // namespace plumbline
