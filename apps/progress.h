// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/system.h"

#include <chrono>
#include <cstddef>
#include <string>

namespace plumbline {

// Shows on stderr how far a job of many equal parts is, with the time left: a bar on a terminal, a
// line every few seconds elsewhere. Not for use from several threads at once.
class Countdown {
 public:
  // `what` are the parts, in the plural.
  Countdown(std::string what, std::size_t total);

  // After each part; `note` is added to the line.
  void Show(std::size_t done, const std::string& note = {});

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  std::size_t total_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
};

// Shows on stderr how far a run is: a bar on a terminal, a line every few seconds elsewhere.
class Progress {
 public:
  Progress(std::size_t total, bool quiet);

  // After each frame.
  void Show(const FrameRecord& frame);

  // A message between two lines of progress. May come from another thread than Show.
  void Say(const std::string& message) const;

 private:
  bool quiet_;
  bool terminal_;
  std::size_t keyframes_ = 0;
  Countdown countdown_;
};

}  // namespace plumbline
