// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/playback_schedule.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {
PlaybackSchedule::Clock::time_point PlaybackSchedule::ReadAt(std::int64_t stamp_ns) const {
  if (!start_) return Clock::time_point::min();
  return start_->due + std::chrono::nanoseconds(stamp_ns - start_->stamp_ns) - reading_.Enough();
}

PlaybackSchedule::Clock::time_point PlaybackSchedule::DueOnceRead(std::int64_t stamp_ns,
                                                                  Clock::time_point begin,
                                                                  Clock::time_point end) {
  reading_.Add(end - begin);
  if (!start_) start_ = {stamp_ns, end};
  return start_->due + std::chrono::nanoseconds(stamp_ns - start_->stamp_ns);
}

void PlaybackSchedule::Delay(Clock::duration pause) {
  if (start_) start_->due += pause;
}

void ReadingTime::Add(Duration taken) {
  constexpr std::size_t kRemembered = 16;
  last_.push_back(taken);
  if (last_.size() > kRemembered) last_.pop_front();
}

ReadingTime::Duration ReadingTime::Enough() const {
  if (last_.empty()) return Duration::zero();
  return *std::max_element(last_.begin(), last_.end()) * 5 / 4;
}

}  // namespace plumbline
