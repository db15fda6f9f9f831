// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/units.h"
#include "plumbline/inertial/inertial_sample.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

constexpr std::int64_t kMotionStart = 1'403'636'579'763'555'584;  // as large as real stamps

// What an ideal sensor measures in a hand that turns by up to 1 rad/s and moves, `t` seconds after
// kMotionStart.
inline InertialSample IdealSample(double t) {
  return {kMotionStart + std::llround(t * kNsPerSecond),
          {0.7 * std::sin(3 * t), 0.5 * std::cos(4 * t + 0.3), 0.4 + 0.3 * std::sin(2 * t)},
          {1.5 * std::cos(5 * t), 9.7 + 0.8 * std::sin(4 * t), 0.6 * std::sin(6 * t + 1)}};
}

// Samples from 0.1 s before to 0.1 s after a stretch of some seconds.
inline std::vector<InertialSample> IdealSamples(double rate_hz, double seconds = 1) {
  std::vector<InertialSample> samples;
  const auto most = static_cast<int>(std::ceil((seconds + 0.1) * rate_hz));
  for (int i = -static_cast<int>(std::ceil(0.1 * rate_hz)); i <= most; ++i) {
    samples.push_back(IdealSample(i / rate_hz));
  }
  return samples;
}

}  // namespace plumbline
