// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/rectified_camera.h"

#include <cstdint>

namespace plumbline {

// Returns a number, never 0, that is the same for the same rig. It is made of all numbers of the
// calibration that say where things appear in the images, and of the ideal camera made from them.
std::uint64_t FingerprintOf(const Calibration& calibration, const RectifiedCamera& camera);

}  // namespace plumbline
