// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/options.h"

#include <cstdint>
#include <deque>

namespace plumbline {

// Maps each frame to the newest task of the mapper whose result it sees. The frame at which a
// keyframe takes effect is part of the algorithm and does not depend on the machine's speed: a task
// submitted at frame f takes effect at frame f + 1 + lag, the start of a map at once. In a live run
// only the start of a map is waited for.
//
// Tasks are numbered from 1 in the order of submission, frames from 0.
class SnapshotSchedule {
 public:
  SnapshotSchedule(RunMode mode, std::int64_t lag) : mode_(mode), lag_(lag) {}

  // Adds a task submitted at a frame.
  void Add(std::int64_t task, std::int64_t frame, bool starts_map) {
    if (mode_ == RunMode::kLive && !starts_map) return;
    dues_.push_back({task, starts_map ? frame : frame + 1 + lag_});
  }
  // Removes the newest task, which could not be submitted.
  void Remove(std::int64_t task) {
    if (!dues_.empty() && dues_.back().task == task) dues_.pop_back();
  }
  // Returns the newest task whose result the frame sees; 0 if there is none beyond those of earlier
  // calls. Frames come in order.
  std::int64_t DueAt(std::int64_t frame) {
    std::int64_t task = 0;
    for (const SnapshotDue& due : dues_) {
      if (due.frame <= frame) task = due.task;
    }
    while (!dues_.empty() && dues_.front().task <= task) dues_.pop_front();
    return task;
  }
  void Clear() { dues_.clear(); }

 private:
  struct SnapshotDue {
    std::int64_t task = 0;
    std::int64_t frame = 0;  // first frame that sees the task's result
  };
  RunMode mode_;
  std::int64_t lag_;
  std::deque<SnapshotDue> dues_;
};

}  // namespace plumbline
