// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/turning_stretch.h"

#include "plumbline/base/units.h"

#include <utility>

namespace plumbline {

void TurningStretch::Add(std::span<const InertialSample> samples) {
  for (const InertialSample& sample : samples) {
    std::vector<InertialSample>& kept = newest_.samples;
    if (!kept.empty()) {
      const std::int64_t whole = sample.stamp_ns - kept.front().stamp_ns;
      if (static_cast<double>(whole) > kSeconds * kNsPerSecond || kept.size() == kMostSamples) {
        if (newest_.turning > best_.turning) std::swap(best_, newest_);
        newest_ = {};
      }
    }
    if (!kept.empty()) {
      const auto ns = static_cast<double>(sample.stamp_ns - kept.back().stamp_ns);
      newest_.turning += ns / kNsPerSecond * sample.angular_rate.squaredNorm();
    }
    kept.push_back(sample);
  }
}

std::span<const InertialSample> TurningStretch::best() const {
  return best_.turning > newest_.turning ? best_.samples : newest_.samples;
}

}  // namespace plumbline
