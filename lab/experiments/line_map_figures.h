// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/metrics.h"
#include "plumbline/eval/trajectory_error.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/sim3.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// Adds the figures of the line map of a run (metrics line_*): its lines.obj, brought into the world
// of the ground truth as its trajectory is, against lines.csv and surfaces.csv of the sequence
// (line_map_error.h), at the tolerance of 5 cm. Where that is not possible, the reasons.
void AddLineMapFigures(const std::filesystem::path& sequence,
                       const std::filesystem::path& run,
                       RunFigures& figures);

// Adds the same of the line landmarks of map.plb with the ends that they have there (metrics
// map_line_*), not of what the end of a run makes of the keyframes' segments. map_line_error: how
// far the further end is from the true line that it is from least, median of all landmarks.
void AddMapLineFigures(const std::filesystem::path& sequence,
                       const std::filesystem::path& run,
                       RunFigures& figures);

// Whether one of these metrics is one of AddMapLineFigures.
bool AsksForMapLines(std::span<const std::string> metrics);

// What brings the map of a run into the world of the ground truth: the motion that its trajectory
// is aligned by (with one camera a similarity, since such a map has a scale of its own), and the
// turn after which poses agree best (AlignPoses).
Similarity3 TrueWorldFromRun(const TrajectoryError& trajectory);

// The lines of a file of a run (ReadLineMap) in the world of the ground truth. Throws InputError
// where they cannot be read.
std::vector<Segment3> ReadLinesInTrueWorld(const std::filesystem::path& file,
                                           const TrajectoryError& trajectory);

}  // namespace plumbline
