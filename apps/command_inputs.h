// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/run_folder.h"

#include "apps/command_line.h"
#include <optional>
#include <vector>

namespace plumbline {

// Returns the input files of a command: the data set, which is the first positional argument, the
// files of --camera, --poses, --config and --mask, if given, and the ground truth. Live sources,
// pipes, and built-in cameras have no path.
std::vector<RunInput> CommandInputs(const CommandLine& line, const Dataset& dataset);

// The help of these options is the same in every command that reads images.
inline constexpr const char* kRotateHelp =
    "turn images clockwise; auto (default): as a video or the EXIF data of stills ask";
inline constexpr const char* kMaxWidthHelp =
    "reduce wider images to this width (default: to 2 megapixels)";
inline constexpr const char* kViewAngleHelp =
    "widest view of the pinhole image cut out of a lens (default: 110 of lenses but radtan)";

// Reads --rotate, --max-width and --view-angle. Throws InputError for invalid values.
Rotation ReadRotation(const CommandLine& line);
std::optional<int> ReadMaxWidth(const CommandLine& line);
std::optional<double> ReadViewAngle(const CommandLine& line);

}  // namespace plumbline
