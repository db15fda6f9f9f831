// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/mapping/line_map.h"

#include "maps.h"
#include <filesystem>
#include <string>
#include <vector>

namespace plumbline::python {

// The line map as the run that made the map gave it out (MakeLineMap). May be called with or
// without the lock of the interpreter.
std::vector<MappedLine> MappedLinesOf(const PyMap& map, const StopCheck& stop);

// KeyFrameTrajectory of a map.
Trajectory KeyFrameTrajectoryOf(const PyMap& map);

// Writes a map as `plumbline map export --to FORMAT` without images does: ply, obj, dxf, tum,
// colmap. Throws InputError for the file that it was read from.
void ExportMap(const PyMap& map, const std::filesystem::path& path, const std::string& format);

}  // namespace plumbline::python
