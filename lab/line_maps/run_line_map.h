// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/line_maps/line_viewers.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/report/trajectory_error.h"
#include "worlds/parallelogram.h"
#include "worlds/true_line.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace plumbline {

// Lines of a run and of the known world that it was in, as CompareLineMaps takes them: metres,
// world of the ground truth.
struct RunLineMap {
  TrajectoryError trajectory;  // of the run
  std::vector<TrueLine> truth;
  std::vector<Parallelogram> surfaces;  // empty if unknown
  std::optional<LineViewers> viewers;   // the keyframes; nullopt if the run has no list of them
  std::vector<Segment3> lines;
};

// Returns the lines of a file of a run, aligned like its poses (TrueWorldFromRun), with those of
// the sequence.
//
//   sequence  folder of a data set with lines.csv, perhaps with surfaces.csv
//   run       folder of a run over it: trajectory.txt, summary.json, perhaps keyframes.txt
//   file      as for ReadLineMap
//   fails     nullopt if CompareRunWithTruth is; throws InputError if a file cannot be read
std::optional<RunLineMap> ReadRunLineMap(const std::filesystem::path& sequence,
                                         const std::filesystem::path& run,
                                         const std::filesystem::path& file);

// Returns the alignment of the map of a run to the world of the ground truth: the alignment of its
// trajectory (with one camera a similarity, since the scale of its map is arbitrary), and the
// rigid motion for which poses agree best (AlignPoses).
Similarity3 TrueWorldFromRun(const TrajectoryError& trajectory);

// Returns the lines of a file in the scale and world of that file: of an .obj its segments
// (ReadObjLines), as written by a run at its end; of a .plb the line landmarks of its active map,
// each between its ends. Throws InputError if the name has another extension, and like ReadObjLines
// and LoadMap.
std::vector<Segment3> ReadLineMap(const std::filesystem::path& path);

// Returns the lines of a file of a run (ReadLineMap) in the world of the ground truth.
std::vector<Segment3> ReadLinesInTrueWorld(const std::filesystem::path& file,
                                           const TrajectoryError& trajectory);

}  // namespace plumbline
