// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/rectified_camera.h"

#include <cstdint>

namespace plumbline {

// A number, never 0, that is the same for the same rig: all numbers of the calibration that say
// where things appear in the images, and the ideal camera that was made of them.
std::uint64_t FingerprintOf(const Calibration& calibration, const RectifiedCamera& camera);

}  // namespace plumbline
