// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/report/summary.h"
#include "plumbline/slam/system.h"

#include "apps/run_frames.h"
#include "apps/stop_signal.h"
#include <chrono>
#include <optional>
#include <string>

namespace plumbline {

// A run whose frames are processed.
struct FinishedRun {
  const System& system;
  const Dataset& dataset;
  const KeptViews& views;
  RunDescription
      description;  // whether it was interrupted is found out when the summary is written
  std::optional<double> first_pose_seconds;
  std::chrono::steady_clock::time_point start;
};

struct WrittenResults {
  std::optional<std::string> failure;     // which files could not be written, in one line
  std::optional<StopSignal> interrupted;  // as the summary has it
  bool earlier_kept = false;              // an earlier run's results stay: these are worth less
};

// Writes all files of a run into the part of its folder, those first that are worth most for their
// size, and puts them in their places. A signal cuts the line map short and leaves out pictures
// that are not drawn yet; the summary and the report tell of it.
//
// Files that cannot be written do not keep the others from it. Where these would replace whole
// results of an earlier run, those stay, and these are in the part. So they do where the run has no
// pose, or was cut off and has fewer poses than the earlier one of the same data.
WrittenResults WriteResults(const FinishedRun& run, RunFolder& folder);

// Returns why a run found no pose at all, in one line; nullopt where a frame has one.
std::optional<std::string> WhyNoPose(const FrameLog& frames, bool no_depth);

// A few lines on standard output.
void PrintResult(const System& system, const Dataset& dataset, const std::string& folder);

}  // namespace plumbline
