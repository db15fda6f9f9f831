// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"

#include "maps.h"
#include <filesystem>
#include <string>

namespace plumbline::python {

// Poses of the left camera as delivered at the keyframes of a map, in the order of time; of
// keyframes of one time the one with the lowest number.
Trajectory KeyFrameTrajectoryOf(const PyMap& map);

// Writes a map as `plumbline map export --to FORMAT` without images does: ply, obj, dxf, tum,
// colmap.
void ExportMap(const PyMap& map, const std::filesystem::path& path, const std::string& format);

}  // namespace plumbline::python
