// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/reading_time.h"

#include <chrono>
#include <cstdint>
#include <optional>

namespace plumbline {

// When the frames of a recording that is played live are read and given out. They are due as far
// apart as they were taken, however long the recording is silent in between; the first one is due
// as soon as it has been read. Each later one is read as long before it is due as reading takes
// (reading_time.h). Asks no clock itself.
class PlaybackSchedule {
 public:
  using Clock = std::chrono::steady_clock;

  // Returns when to begin to read the frame of this stamp: for the first frame a time long past.
  Clock::time_point ReadAt(std::int64_t stamp_ns) const;
  // Returns when the frame of this stamp is due, which was read from `begin` to `end`, or could not
  // be read in this time. A frame that took longer than expected delays no others.
  Clock::time_point DueOnceRead(std::int64_t stamp_ns,
                                Clock::time_point begin,
                                Clock::time_point end);
  // All frames to come are due that much later. Before the first frame nothing is to be delayed.
  void Delay(Clock::duration pause);

 private:
  // The first frame.
  struct Start {
    std::int64_t stamp_ns;
    Clock::time_point due;
  };

  std::optional<Start> start_;
  ReadingTime reading_;
};

}  // namespace plumbline
