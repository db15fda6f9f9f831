// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>

namespace plumbline {

// How long reading a frame of a recording takes, as far as the last frames tell. A recording that
// is played live is read so long before a frame is due: read at once, the next frame would take the
// processor from the one that is being tracked, which a camera does not do.
class ReadingTime {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // What a frame took.
  void Add(Duration taken);
  // What is enough for the next one: the longest of the last sixteen and a quarter more. Zero
  // before the first.
  Duration Enough() const;

 private:
  std::deque<Duration> last_;
};

}  // namespace plumbline
