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

// Reports progress on stderr: a bar on a terminal, otherwise a line every few seconds.
class ProgressLine {
 public:
  // `every`: least time between two lines where there is no terminal.
  explicit ProgressLine(bool quiet, std::chrono::milliseconds every = std::chrono::seconds(5));

  // May be called at any rate; the end, done == total, is always shown.
  void Show(std::size_t done, std::size_t total, const std::string& text);

  // Shows progress whose total is unknown.
  void ShowOpen(const std::string& text);
  // To be called after the last ShowOpen.
  void End() const;

  // Prints a message between two lines of progress. May be called from another thread than Show.
  void Say(const std::string& message) const;

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  bool terminal_;
  Clock::duration every_;
  Clock::time_point shown_ = Clock::now();
};

// Reports progress of a job of many equal parts, with the time left. Not thread-safe.
class Countdown {
 public:
  // `what` are the parts, in the plural; total is nullopt if unknown.
  Countdown(std::string what, std::optional<std::size_t> total, bool quiet = false)
      : what_(std::move(what)), total_(total), line_(quiet) {}

  // To be called after each part; `note` is added to the line.
  void Show(std::size_t done, const std::string& note = {});

  // To be called after the last part.
  void End() const {
    if (!total_) line_.End();
  }

  // See ProgressLine.
  void Say(const std::string& message) const { line_.Say(message); }

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  std::optional<std::size_t> total_;
  ProgressLine line_;
  Clock::time_point start_ = Clock::now();
};

// Shows the progress of a run.
class Progress {
 public:
  Progress(std::optional<std::size_t> total, bool quiet) : countdown_("frames", total, quiet) {}

  // To be called after each frame.
  void Show(const FrameRecord& frame);

  void End() const { countdown_.End(); }

  // See ProgressLine.
  void Say(const std::string& message) const { countdown_.Say(message); }

 private:
  Countdown countdown_;
};

// Shows for how long the maps have been adjusted after the last frame. Not thread-safe.
class AdjustmentProgress {
 public:
  explicit AdjustmentProgress(const ProgressLine& line) : line_(line) {}
  // Ends the line on a terminal.
  ~AdjustmentProgress();
  AdjustmentProgress(const AdjustmentProgress&) = delete;
  AdjustmentProgress& operator=(const AdjustmentProgress&) = delete;

  // May be called at any rate; shows nothing in the first moments.
  void Show();

 private:
  using Clock = std::chrono::steady_clock;

  ProgressLine line_;
  Clock::time_point start_ = Clock::now(), shown_ = start_;
};

}  // namespace plumbline
