// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// Sets the distortion of a camera from the name of a model as written by ROS, OpenCV, Foxglove and
// drivers of cameras, in any case and with blanks or underscores:
//
//   plumb_bob, rational_polynomial, radtan, radial_tangential, Brown Conrady
//                      k1 k2 p1 p2 [k3], followed only by zeros
//   equidistant, fisheye, Kannala Brandt, kannala_brandt4
//                      k1 k2 k3 k4, followed only by zeros
//   none, "", Inverse Brown Conrady, Modified Brown Conrady, others
//                      no distortion, if there are no numbers or all are 0
//
// Returns the reason if the model cannot be used, as "expected ..., found ...".
std::optional<std::string> SetNamedDistortion(std::string_view model,
                                              std::span<const double> numbers,
                                              CameraIntrinsics& intrinsics);

}  // namespace plumbline
