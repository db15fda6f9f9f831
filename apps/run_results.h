// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/report/summary.h"
#include "plumbline/slam/run_result.h"

#include "apps/run_frames.h"
#include "apps/stop_signal.h"
#include <chrono>
#include <optional>
#include <string>

namespace plumbline {

// A run with all frames processed.
struct FinishedRun {
  const RunResult& result;
  const Dataset& dataset;
  const KeptViews& views;
  RunDescription
      description;  // without the interruption, which is determined when the summary is written
  std::optional<double> first_pose_seconds;
  std::chrono::steady_clock::time_point start;
  bool live = false;  // a signal is the usual end of a live source
};

struct WrittenResults {
  std::optional<std::string> failure;     // files that could not be written, in one line
  std::optional<StopSignal> interrupted;  // as in the summary
  bool earlier_kept = false;              // true if better results of an earlier run are kept
};

// Writes all files of a run into the part of its folder, the most valuable for their size first,
// and moves them into place. A signal cuts the line map short and leaves out pictures not yet
// drawn, as the summary and the report state.
//
// Files that cannot be written do not prevent the others. If these would replace complete results
// of an earlier run, the earlier ones stay, and the new ones are left in the part. The same applies
// if the run has no pose, or was interrupted and has fewer poses than the earlier one of the same
// data.
WrittenResults WriteResults(const FinishedRun& run, RunFolder& folder);

// Returns the sentence for WrittenResults::earlier_kept, with the place of the new results.
std::string NoteOfEarlierKept(const RunFolder& folder);

// Returns the reason why a run found no pose at all, in one line; nullopt if a frame has one.
std::optional<std::string> WhyNoPose(const FrameLog& frames, bool no_depth);

// Prints a few lines on standard output.
void PrintResult(const RunResult& result, const Dataset& dataset, const std::string& folder);

}  // namespace plumbline
