// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>

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

}  // namespace plumbline
