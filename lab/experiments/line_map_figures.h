// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/metrics.h"

#include <filesystem>

namespace plumbline {

// Adds the figures of the line map of a run (metrics line_*): its lines.obj, brought into the world
// of the ground truth as its trajectory is, against lines.csv and surfaces.csv of the sequence
// (line_map_error.h), at the tolerance of 5 cm. Where that is not possible, the reasons.
void AddLineMapFigures(const std::filesystem::path& sequence,
                       const std::filesystem::path& run,
                       RunFigures& figures);

}  // namespace plumbline
