// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_sample.h"

#include <cstddef>
#include <span>
#include <vector>

namespace plumbline {

// Keeps those samples of a run of any length that tell most about rotation and clock of a sensor
// (AlignRates): of stretches of ten minutes the one whose squared rates have the largest integral.
// Holds two stretches at most.
class TurningStretch {
 public:
  static constexpr double kSeconds = 600;
  // A stretch ends after this number of samples, too: 10 minutes at 1 kHz.
  static constexpr std::size_t kMostSamples = 600'000;

  // Takes samples in order of time.
  void Add(std::span<const InertialSample> samples);
  // The stretch of all samples so far; valid until the next Add.
  std::span<const InertialSample> best() const;
  std::size_t held() const { return best_.samples.size() + newest_.samples.size(); }

 private:
  struct Stretch {
    std::vector<InertialSample> samples;
    double turning = 0;  // rad^2/s
  };

  Stretch best_;    // of the stretches that ended
  Stretch newest_;  // not yet ended
};

}  // namespace plumbline
