// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>

namespace plumbline {

// Threads and time of a live run: either threads and the clock of the machine, or the caller, who
// does one step at a time and moves the clock.
struct Execution {
  using Clock = std::chrono::steady_clock;

  // If false, no threads are made: their work waits for calls of Pipeline::WorkOnce and
  // System::MapOnce. For live runs only.
  bool threads = true;
  // Returns the time. It is called from the feeding and the tracking thread.
  std::function<Clock::time_point()> now = [] { return Clock::now(); };
};

}  // namespace plumbline
