// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/system.h"

#include <chrono>
#include <cstddef>
#include <string>

namespace plumbline {

// Shows on stderr how far a run is: a bar on a terminal, a line every few seconds elsewhere.
class Progress {
 public:
  Progress(std::size_t total, bool quiet);

  // After each frame.
  void Show(const FrameRecord& frame);

  // A message between two lines of progress. May come from another thread than Show.
  void Say(const std::string& message) const;

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t total_;
  bool quiet_;
  bool terminal_;
  std::size_t keyframes_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
};

}  // namespace plumbline
