// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>

namespace plumbline {

// Says who does the work of a live run, and what time it is: either threads and the clock of the
// machine, or the caller, who does one step at a time and moves the clock.
struct Execution {
  using Clock = std::chrono::steady_clock;

  // If false, no threads are made: their work waits until Pipeline::WorkOnce and System::MapOnce
  // are called. For live runs only.
  bool threads = true;
  // Returns the time. It is called from the thread that feeds and from the one that tracks.
  std::function<Clock::time_point()> now = [] { return Clock::now(); };
};

}  // namespace plumbline
