// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace plumbline {

// Makes the stamps of a source increase. After a clock that is set back, a device that starts anew
// or a recording that begins again, stamps go on one interval behind the last frame. Later stamps
// are shifted alike, so that times between them stay as they were, until the source's stamp is
// later than the last one given: a single stamp that was not set (0) changes no others. Stamps that
// increase are not changed. Behind the latest stamp that files may hold (kLatestStampNs), stamps go
// on by a nanosecond each.
class StampContinuity {
 public:
  struct Stamp {
    std::int64_t stamp_ns = 0;  // the stamp to be used
    // Set for the first frame after a jump back: the size of the jump of the source's stamps.
    std::optional<std::int64_t> jumped_back_ns;
  };

  // Returns the stamp of the next frame, for the stamp that its source gave.
  Stamp Next(std::int64_t source_ns);

 private:
  // A step ahead may be a clock that was set, which is no interval to go on by.
  static constexpr std::int64_t kLongestInterval = 1'000'000'000;

  std::int64_t Behind() const;  // the next stamp after the last one

  std::optional<std::int64_t> last_source_ns_;
  std::int64_t last_ns_ = 0;
  std::int64_t offset_ns_ = 0;  // what is added to stamps at present
  // Interval between the last two frames; at first a common one of cameras.
  std::int64_t interval_ns_ = 33'333'333;
};

}  // namespace plumbline
