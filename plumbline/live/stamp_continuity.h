// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace plumbline {

// Makes the stamps of a source increase. A clock that is set back, a device that starts anew or a
// recording that begins again go on one interval behind the frame before, and so do all stamps
// behind: times between them stay what they were. Stamps that increase are not changed.
class StampContinuity {
 public:
  struct Stamp {
    std::int64_t stamp_ns = 0;  // to be used
    // Set for the first frame after a jump back: by how much the source's stamps jumped.
    std::optional<std::int64_t> jumped_back_ns;
  };

  // The stamp that the next frame gets, for the one that its source gave.
  Stamp Next(std::int64_t source_ns);

 private:
  std::optional<std::int64_t> last_source_ns_;
  std::int64_t last_ns_ = 0;
  std::int64_t offset_ns_ = 0;             // that is added now
  std::int64_t interval_ns_ = 33'333'333;  // between the last two frames; at first some camera's
};

}  // namespace plumbline
