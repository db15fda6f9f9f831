// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/reading_time.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {

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
