// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/metrics.h"

#include <filesystem>

namespace plumbline {

// Adds rpe_pairs to the figures of a run: for all pairs of frames with a pose the error of the
// relative position, RMSE, like the tool of the TUM RGB-D benchmark without a given time distance
// (of more than 1000 frames, 1000 evenly taken ones). The estimate is aligned first, with one
// camera its scale too. And start_rpe: the same, but a metre for a run without a pose.
//
//   sequence  folder of the data; without ground truth, or if a file cannot be read, a reason is
//             added instead
//   run       folder of the run
//   cost      O(pairs)
void AddPairFigures(const std::filesystem::path& sequence,
                    const std::filesystem::path& run,
                    RunFigures& figures);

// Adds start_frames: the number of frames given to the run up to and including its first reported
// pose, from its frames.csv and trajectory_causal.txt.
void AddStartFigure(const std::filesystem::path& run, RunFigures& figures);

}  // namespace plumbline
