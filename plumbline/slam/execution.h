// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>

namespace plumbline {

// Who does the work of a live run, and what time it is for it: threads and the clock of the
// machine, or, step by step, the caller, who moves the clock.
struct Execution {
  using Clock = std::chrono::steady_clock;

  // False, for live runs alone: what would be a thread's work waits until Pipeline::WorkOnce and
  // System::MapOnce are called.
  bool threads = true;
  // Called from the thread that feeds and from the one that tracks.
  std::function<Clock::time_point()> now = [] { return Clock::now(); };
};

}  // namespace plumbline
