// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/live/stamp_continuity.h"

namespace plumbline {

StampContinuity::Stamp StampContinuity::Next(std::int64_t source_ns) {
  Stamp stamp{source_ns + offset_ns_, std::nullopt};
  if (last_source_ns_) {
    if (source_ns <= *last_source_ns_) {
      stamp.jumped_back_ns = *last_source_ns_ - source_ns;
      stamp.stamp_ns = last_ns_ + interval_ns_;
      offset_ns_ = stamp.stamp_ns - source_ns;
    } else {
      interval_ns_ = source_ns - *last_source_ns_;
    }
  }
  last_source_ns_ = source_ns;
  last_ns_ = stamp.stamp_ns;
  return stamp;
}

}  // namespace plumbline
