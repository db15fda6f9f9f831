// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/rectified_camera.h"

#include <optional>
#include <string>

namespace plumbline {

// Returns the view angle (Calibration::view_angle_deg, whole degrees) with which a camera gives the
// rectified camera of a map; nullopt if it does so as calibrated, and if no angle does.
std::optional<double> ViewAngleOfMap(const RectifiedCamera& of_map, const Calibration& calibration);

// Returns "view angles of 55 and 60 degrees" if a calibration gives the rectified camera of a map,
// but with another view angle than its own, or as by default; nullopt if it does with its own, has
// none, or is of another camera.
std::optional<std::string> ViewAngleDifference(const RectifiedCamera& of_map,
                                               Calibration calibration);

}  // namespace plumbline
