// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/metrics.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// Adds the figures of the line map of a run (metrics line_*): its lines.obj, aligned to the world
// of the ground truth like its trajectory, against lines.csv and surfaces.csv of the sequence
// (line_map_error.h), at the tolerance of 5 cm. If that is impossible, the reasons.
void AddLineMapFigures(const std::filesystem::path& sequence,
                       const std::filesystem::path& run,
                       RunFigures& figures);

// Adds the same for the line landmarks of map.plb with their own ends (metrics map_line_*), not for
// the line map that a run makes at its end from the keyframes' segments. map_line_error: the
// distance of the further end from the nearest true line, median of all landmarks.
void AddMapLineFigures(const std::filesystem::path& sequence,
                       const std::filesystem::path& run,
                       RunFigures& figures);

// Returns true if one of these metrics is one of AddMapLineFigures.
bool AsksForMapLines(std::span<const std::string> metrics);

}  // namespace plumbline
