// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/rectified_camera.h"

#include <optional>

namespace plumbline {

// Returns the view angle (Calibration::view_angle_deg, whole degrees) with which a camera gives the
// rectified camera of a map; nullopt if it does so as calibrated, and if no angle does.
std::optional<double> ViewAngleOfMap(const RectifiedCamera& of_map, const Calibration& calibration);

}  // namespace plumbline
