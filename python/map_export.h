// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/datasets/dataset.h"
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

// Returns the line map as in the run that made the map (MakeLineMap). May be called with or without
// the GIL.
std::vector<MappedLine> MappedLinesOf(const PyMap& map, const StopCheck& stop);

// KeyFrameTrajectory of a map.
Trajectory KeyFrameTrajectoryOf(const PyMap& map);

// Data of a map: an open data set, or its path.
using ImageSource = std::variant<std::shared_ptr<Dataset>, std::filesystem::path>;
// Poses of frames, or their file.
using PoseSource = std::variant<PoseList, std::filesystem::path>;

// The images of an export: their source, frames, poses of frames other than keyframes, and form.
struct ExportedImages {
  std::optional<ImageSource> source;
  std::string frames;
  std::optional<PoseSource> trajectory;
  bool undistort = false;
};

// Writes a map like `plumbline map export --to FORMAT`, with the same checks. Holds the GIL.
void ExportMap(const PyMap& map,
               const std::filesystem::path& path,
               const std::string& format,
               const ExportedImages& images);

}  // namespace plumbline::python
