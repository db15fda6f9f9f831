// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"

namespace plumbline {

// Returns true if one frame of the camera measures depth: it is a pair, or has depth images.
inline bool MeasuresDepth(const RectifiedCamera& camera) { return camera.baseline > 0; }

// Returns true if lengths of the camera's maps are in metres: maps have no scale to be found or
// to drift, and do not change it when they are joined. So far only measured depth tells the unit.
inline bool KnowsUnitOfLength(const RectifiedCamera& camera) { return MeasuresDepth(camera); }

}  // namespace plumbline
