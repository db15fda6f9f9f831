// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/dataset.h"
#include "plumbline/mapping/line_map.h"

#include "maps.h"
#include "trajectories.h"
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace plumbline::python {

// The line map as the run that made the map gave it out (MakeLineMap). May be called with or
// without the lock of the interpreter.
std::vector<MappedLine> MappedLinesOf(const PyMap& map, const StopCheck& stop);

// KeyFrameTrajectory of a map.
Trajectory KeyFrameTrajectoryOf(const PyMap& map);

// The data that a map was made from: open, or where they are.
using ImageSource = std::variant<std::shared_ptr<Dataset>, std::filesystem::path>;
// Poses of frames, or the file that has them.
using PoseSource = std::variant<PoseList, std::filesystem::path>;

// Writes a map as `plumbline map export --to FORMAT` does, with the same checks. Holds the lock of
// the interpreter.
void ExportMap(const PyMap& map,
               const std::filesystem::path& path,
               const std::string& format,
               const std::optional<ImageSource>& images,
               const std::string& frames,
               const std::optional<PoseSource>& trajectory);

}  // namespace plumbline::python
