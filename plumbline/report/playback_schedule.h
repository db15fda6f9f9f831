// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace plumbline {

// Estimated time to read a frame of a recording, from the last frames. A recording played live is
// read ahead by this time only: read earlier, the next frame would compete with tracking for the
// processor, which a camera does not do.
class ReadingTime {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // Adds the time that a frame took.
  void Add(Duration taken);
  // Returns a sufficient time for the next frame: the longest of the last sixteen and a quarter
  // more. Zero before the first.
  Duration Enough() const;

 private:
  std::deque<Duration> last_;
};

// Schedule of reading and delivering the frames of a recording played live. They are due at the
// intervals of their stamps, however long the pauses of the recording; the first one is due as soon
// as it has been read. Each later one is read ahead by the time that reading takes (ReadingTime).
// Reads no clock itself.
class PlaybackSchedule {
 public:
  using Clock = std::chrono::steady_clock;

  // Returns the time to begin reading the frame of this stamp: for the first frame a time long
  // past.
  Clock::time_point ReadAt(std::int64_t stamp_ns) const;
  // Returns the due time of the frame of this stamp, which was read, or failed to be read, from
  // `begin` to `end`. A frame that took longer than expected delays no others.
  Clock::time_point DueOnceRead(std::int64_t stamp_ns,
                                Clock::time_point begin,
                                Clock::time_point end);
  // Shifts the schedule of all later frames by `pause`. Does nothing before the first frame.
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
