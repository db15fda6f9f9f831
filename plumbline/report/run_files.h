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
  std::string final_estimate, causal, keyframes, covariance;
};

// trajectory_covariance.txt: one row for each pose whose covariance is known, its stamp as in the
// trajectories and 36 numbers, the matrix row by row.
std::string FormatCovariances(const std::vector<StampedCovariance>& covariances);

// frames.csv: one row for each input frame with what became of it. `final_map` is the map that a
// pose is part of in the end: the one in which it was reported may have become part of another one,
// which `atlas` knows.
std::string FormatFrameRow(const FrameRecord& frame, MapId final_map);
std::string FormatFrames(const FrameLog& frames, const Atlas& atlas = {});

// The functions below return the files of a finished run, those first that are worth most for their
// size. The files refer to the system, which must live on, and look at it only when they are
// written. Each is written whole or not at all; writing throws WriteError.
//
// time_mirror_ns is DatasetInfo::time_mirror_ns. After a run backwards a frame has the stamp of its
// recording in all text files, so that they can be compared with the data's own ground truth.
// Trajectories are in the order of these stamps, rows of frames in the order played. map.plb keeps
// the stamps as played.

// Returns trajectory.txt, trajectory_causal.txt, keyframes.txt (of the map with most frames; then
// those of other maps as *_map<k>.txt), frames.csv, and trajectory_covariance.txt (then those of
// other maps).
std::vector<RunFile> PoseFiles(const System& system,
                               std::optional<std::int64_t> time_mirror_ns = std::nullopt);

// Returns map.plb: the whole atlas (SaveAtlas). The map to go on with is the one with most frames;
// after a run that only reads its maps it stays the same.
RunFile MapFile(const System& system);

// Returns timing.csv, timing.json, and lines.obj, lines.dxf and map.ply (the line map,
// System::LineMap).
std::vector<RunFile> DerivedFiles(const System& system,
                                  std::optional<std::int64_t> time_mirror_ns = std::nullopt);

}  // namespace plumbline
