// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/stamp_continuity.h"

#include "plumbline/io/text_rows.h"

#include <algorithm>

namespace plumbline {

StampContinuity::Stamp StampContinuity::Next(std::int64_t source_ns) {
  Stamp stamp{source_ns, std::nullopt};
  if (last_source_ns_) {
    const bool back = source_ns <= *last_source_ns_;
    if (back) stamp.jumped_back_ns = *last_source_ns_ - source_ns;
    if (source_ns > last_ns_) {
      offset_ns_ = 0;
    } else if (back || source_ns > kLatestStampNs - offset_ns_) {
      offset_ns_ = Behind() - source_ns;
    }
    stamp.stamp_ns = source_ns + offset_ns_;
    if (!back) interval_ns_ = std::min(stamp.stamp_ns - last_ns_, kLongestInterval);
  }
  last_source_ns_ = source_ns;
  last_ns_ = stamp.stamp_ns;
  return stamp;
}

// At the latest time there is, stamps can but be told apart.
std::int64_t StampContinuity::Behind() const {
  return last_ns_ + (interval_ns_ <= kLatestStampNs - last_ns_ ? interval_ns_ : 1);
}

}  // namespace plumbline
