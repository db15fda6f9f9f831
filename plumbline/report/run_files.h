// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/run_folder.h"
#include "plumbline/slam/run_result.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// File names of a map's trajectories: plain ones, or with the number of one map of several.
struct TrajectoryNames {
  explicit TrajectoryNames(std::optional<MapId> map = std::nullopt);
  std::string final_estimate, causal, keyframes, covariance;
};

// trajectory_covariance.txt: one row for each pose with a known covariance, its stamp as in the
// trajectories and 36 numbers, the matrix row by row.
std::string FormatCovariances(const std::vector<StampedCovariance>& covariances);

// frames.csv: one row for each input frame with its result. `final_map` is the final map of a pose:
// the map in which it was reported may have been merged into another one, as `atlas` records.
std::string FormatFrameRow(const FrameRecord& frame, MapId final_map);
std::string FormatFrames(const FrameLog& frames, const Atlas& atlas = {});

// The functions below return the files of a finished run, by descending value for their size. The
// files refer to the result, which must outlive them, and read it only when they are written. Each
// is written atomically; writing throws WriteError.

// Returns trajectory.txt, trajectory_causal.txt, keyframes.txt (of the map with most frames; then
// those of other maps as *_map<k>.txt), frames.csv, and trajectory_covariance.txt (then those of
// other maps).
std::vector<RunFile> PoseFiles(const RunResult& result);

// Returns map.plb: the whole atlas (SaveAtlas). The active map is the one with most frames; after a
// run with read-only maps it is unchanged.
RunFile MapFile(const RunResult& result);

// Returns timing.csv, timing.json, and lines.obj, lines.dxf and map.ply (the line map,
// RunResult::LineMap).
std::vector<RunFile> DerivedFiles(const RunResult& result);

}  // namespace plumbline
