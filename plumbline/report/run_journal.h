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

// Keeps on the disk what a run has so far: the causal trajectories, frames.csv, and keyframes with
// the poses they were first given, in the part of its folder, by the names that they have at the
// end. Whatever ends the program, no more than the last seconds are lost.
//
// Every file is written anew and renamed, so that each is whole at any time.
class RunJournal {
 public:
  using Clock = std::chrono::steady_clock;

  // time_mirror_ns as in run_files.h.
  explicit RunJournal(std::optional<std::int64_t> time_mirror_ns = std::nullopt)
      : time_mirror_ns_(time_mirror_ns) {}

  // What came of the next frame, as first reported. May be called in another thread than the rest.
  void Add(const FrameRecord& record);

  // Writes all there is. Returns why that failed, once; later calls try again and return nothing.
  std::optional<std::string> Write(RunFolder& folder);
  // Writes when the last time is long enough ago that writing takes little of the time: 1 to 8 s.
  std::optional<std::string> WriteIfDue(RunFolder& folder, Clock::time_point now = Clock::now());

 private:
  // Rows of the files of one map.
  struct MapText {
    std::string causal, keyframes;
    int frames = 0;
  };

  void TakeIn(const std::vector<FrameRecord>& records);
  void WriteFiles(RunFolder& folder);

  std::optional<std::int64_t> time_mirror_ns_;
  std::mutex mutex_;
  std::vector<FrameRecord> added_;  // since the last Write; guarded by mutex_
  std::string frames_;
  std::map<MapId, MapText> maps_;
  std::set<std::string> written_;  // names of files
  Clock::time_point last_ = Clock::now();
  Clock::duration taken_{};  // by the last Write
  bool failed_ = false;
};

}  // namespace plumbline
