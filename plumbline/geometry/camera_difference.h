// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"

#include <optional>
#include <string>

#include <Eigen/Geometry>

namespace plumbline {

// A rectified camera and its rotation relative to the left camera as delivered.
struct TurnedCamera {
  RectifiedCamera camera;
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
};

// Returns the differences of two cameras, such as "fx 458.6 and 460.1" or "images of 752x480 and
// 640x480 pixels"; nullopt if they are equal up to rounding (1e-9 of each number; 1e-9 radians).
std::optional<std::string> CameraDifference(const TurnedCamera& a, const TurnedCamera& b);

}  // namespace plumbline
