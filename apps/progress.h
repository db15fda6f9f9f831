// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/system.h"

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace plumbline {

// Says on stderr how far something is: a bar on a terminal, a line every few seconds elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);

  // May be called as often as one likes; the end, done == total, is always shown.
  void Show(std::size_t done, std::size_t total, const std::string& text);

  // The same where nobody knows how much there will be.
  void ShowOpen(const std::string& text);
  // Behind the last ShowOpen.
  void End() const;

  // A message between two lines of progress. May come from another thread than Show.
  void Say(const std::string& message) const;

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  bool terminal_;
  Clock::time_point shown_ = Clock::now();
};

// The same for a job of many equal parts, with the time left. Not for use from several threads at
// once.
class Countdown {
 public:
  // `what` are the parts, in the plural; total is nullopt where nobody knows it.
  Countdown(std::string what, std::optional<std::size_t> total, bool quiet = false)
      : what_(std::move(what)), total_(total), line_(quiet) {}

  // After each part; `note` is added to the line.
  void Show(std::size_t done, const std::string& note = {});

  // When there will be no more parts.
  void End() const {
    if (!total_) line_.End();
  }

  // As of ProgressLine.
  void Say(const std::string& message) const { line_.Say(message); }

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  std::optional<std::size_t> total_;
  ProgressLine line_;
  Clock::time_point start_ = Clock::now();
};

// Shows how far a run is.
class Progress {
 public:
  Progress(std::optional<std::size_t> total, bool quiet) : countdown_("frames", total, quiet) {}

  // After each frame.
  void Show(const FrameRecord& frame);

  void End() const { countdown_.End(); }

  // As of ProgressLine.
  void Say(const std::string& message) const { countdown_.Say(message); }

 private:
  Countdown countdown_;
};

}  // namespace plumbline
