// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
#include "plumbline/slam/system.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// frames.csv: what came of every input frame.
std::string FormatFrames(const std::vector<FrameRecord>& frames);

// Removes the files of an earlier run from a folder, and what a killed one left behind under
// temporary names, so that a run's folder never holds files of two runs. Other files stay. Throws
// InputError when a file cannot be removed.
void RemoveEarlierRun(const std::filesystem::path& folder);

// Writes trajectory.txt, trajectory_causal.txt, keyframes.txt (of the map with most frames; others
// as *_map<k>.txt), frames.csv, timing.csv, timing.json, map.plb (all landmarks), map.ply,
// lines.obj and lines.dxf (the line map, System::LineMap). Each file is written whole or not at
// all. Throws InputError when a file cannot be written.
//
// time_mirror_ns is DatasetInfo::time_mirror_ns: after a run backwards a frame has the stamp of its
// recording in all text files, so that they compare with the data's own ground truth. Trajectories
// are in the order of these stamps, rows of frames in the order played. map.plb keeps the stamps
// as played.
void WriteRunFiles(const System& system,
                   const std::filesystem::path& folder,
                   std::optional<std::int64_t> time_mirror_ns = std::nullopt);

}  // namespace plumbline
