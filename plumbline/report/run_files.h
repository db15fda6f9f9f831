// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/run_folder.h"
#include "plumbline/slam/system.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Names of the files of a map's trajectories: the plain ones, or those of one map of several.
struct TrajectoryNames {
  explicit TrajectoryNames(std::optional<MapId> map = std::nullopt);
  std::string final_estimate, causal, keyframes;
};

// frames.csv: what came of every input frame; a row of it. The map that a pose was reported in may
// have become part of another one, which `atlas` knows: `final_map`.
std::string FormatFrameRow(const FrameRecord& frame, MapId final_map);
std::string FormatFrames(const FrameLog& frames, const Atlas& atlas = {});

// The files of a finished run, those first that are worth most for their size. They refer to the
// system, which must live on, and look at it only when they are written. Each is written whole or
// not at all; writing throws WriteError.
//
// time_mirror_ns is DatasetInfo::time_mirror_ns: after a run backwards a frame has the stamp of its
// recording in all text files, so that they compare with the data's own ground truth. Trajectories
// are in the order of these stamps, rows of frames in the order played. map.plb keeps the stamps
// as played.

// trajectory.txt, trajectory_causal.txt, keyframes.txt (of the map with most frames; then those of
// others as *_map<k>.txt), frames.csv.
std::vector<RunFile> PoseFiles(const System& system,
                               std::optional<std::int64_t> time_mirror_ns = std::nullopt);

// map.plb: all landmarks of the map with most frames.
RunFile MapFile(const System& system);

// timing.csv, timing.json, lines.obj, lines.dxf and map.ply (the line map, System::LineMap).
std::vector<RunFile> DerivedFiles(const System& system,
                                  std::optional<std::int64_t> time_mirror_ns = std::nullopt);

}  // namespace plumbline
