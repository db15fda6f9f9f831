// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/run_folder.h"
#include "plumbline/slam/frame_record.h"

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace plumbline {

// Writes what tracking reports into the part of a run's folder while the run goes on, under the
// names of the results: causal trajectories, frames.csv, and keyframes with their first poses. The
// plain names are those of the first map, others have the number of their map. If the program is
// killed, only results since the last write are lost (WriteIfDue).
//
// Rows are appended, all that are new to a file in one write: a kill leaves whole rows, unless it
// hits that write between two pages of memory.
class RunJournal {
 public:
  using Clock = std::chrono::steady_clock;

  RunJournal();

  // Adds the record of the next frame as first reported. May be called in another thread than the
  // other functions.
  void Add(const FrameRecord& record);

  // Writes everything new. Returns the reason of a failure, only once; later calls try again and
  // return nothing.
  std::optional<std::string> Write(RunFolder& folder);
  // Writes if the last write was a second ago.
  std::optional<std::string> WriteIfDue(RunFolder& folder, Clock::time_point now = Clock::now());

 private:
  using Rows = std::map<std::string, std::string>;  // by file

  std::mutex mutex_;
  Rows new_;  // not yet written; guarded by mutex_
  std::optional<MapId> first_;
  Clock::time_point last_ = Clock::now();
  bool failed_ = false;
};

}  // namespace plumbline
