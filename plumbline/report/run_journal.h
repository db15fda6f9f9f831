// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/run_folder.h"
#include "plumbline/slam/system.h"

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace plumbline {

// Writes the current results of a run into the part of its folder, under the names of the results:
// the causal trajectories, frames.csv, and keyframes with their first poses. If the program is
// killed, only results since the last write are lost (WriteIfDue).
//
// Every file is written anew and renamed, so that each is always complete.
class RunJournal {
 public:
  using Clock = std::chrono::steady_clock;

  // Adds the record of the next frame as first reported. May be called in another thread than the
  // other functions.
  void Add(const FrameRecord& record);

  // Writes everything. Returns the reason of a failure, only once; later calls try again and return
  // nothing.
  std::optional<std::string> Write(RunFolder& folder);
  // Writes if the last write was a second ago and twenty times its own duration: files grow with
  // the run, and writing may take a twentieth of the time at most.
  std::optional<std::string> WriteIfDue(RunFolder& folder, Clock::time_point now = Clock::now());

 private:
  // The rows of the files of one map.
  struct MapText {
    std::string causal, keyframes;
    int frames = 0;
  };

  void TakeIn(const std::vector<FrameRecord>& records);
  void WriteFiles(RunFolder& folder);

  std::mutex mutex_;
  std::vector<FrameRecord> added_;  // since the last Write; guarded by mutex_
  std::string frames_;
  std::map<MapId, MapText> maps_;
  std::set<std::string> written_;  // names of written files
  Clock::time_point last_ = Clock::now();
  Clock::duration taken_{};  // duration of the last Write
  bool failed_ = false;
};

}  // namespace plumbline
