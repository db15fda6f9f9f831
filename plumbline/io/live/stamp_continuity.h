// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace plumbline {

// Makes the stamps of a source increase. After a backward jump (a clock set back, a restarted
// device or recording), stamps continue one interval after the last frame. Later stamps are shifted
// alike, which keeps the times between them, until the source's stamp is later than the last
// returned one: a single unset stamp (0) changes no others. Increasing stamps are unchanged. Beyond
// the latest stamp of files (kLatestStampNs), stamps increase by a nanosecond each.
class StampContinuity {
 public:
  struct Stamp {
    std::int64_t stamp_ns = 0;  // stamp to be used
    // Set for the first frame after a jump back: the size of the jump of the source's stamps.
    std::optional<std::int64_t> jumped_back_ns;
  };

  // Returns the stamp of the next frame, given that of its source.
  Stamp Next(std::int64_t source_ns);

 private:
  // A longer step may be a clock that was set, not the interval of frames.
  static constexpr std::int64_t kLongestInterval = 1'000'000'000;

  std::int64_t Behind() const;  // the next stamp after the last one

  std::optional<std::int64_t> last_source_ns_;
  std::int64_t last_ns_ = 0;
  std::int64_t offset_ns_ = 0;  // current shift of stamps
  // Interval between the last two frames; initially a common one of cameras.
  std::int64_t interval_ns_ = 33'333'333;
};

}  // namespace plumbline
