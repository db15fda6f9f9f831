// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_sample.h"

#include <cstddef>
#include <span>
#include <vector>

namespace plumbline {

// Samples in order of time.
struct OrderedSamples {
  std::vector<InertialSample> samples;  // stamps strictly increasing
  std::size_t backward = 0;             // left out: their stamp is before that of a former sample
  std::size_t repeated = 0;             // left out: their stamp is that of the former sample
};

// Leaves out samples whose stamp does not increase: which of two is right is not known, and a later
// stamp that was believed cannot be taken back in a live run.
OrderedSamples InOrderOfTime(std::span<const InertialSample> samples);

// Joins the samples of a gyroscope (their angular_rate) with those of an accelerometer (their
// specific_force) that were sampled apart: the slower one, by its median interval, is interpolated
// linearly at the stamps of the faster one. Stamps without samples of the slower one around them
// are left out. The stamps of both must increase strictly.
std::vector<InertialSample> JoinedSamples(std::span<const InertialSample> gyroscope,
                                          std::span<const InertialSample> accelerometer);

// Returns the median interval of samples in order of time, in seconds; 0 if there are less than 2.
double MedianInterval(std::span<const InertialSample> samples);

// Returns the sample at a stamp between two neighbours, linear in time.
InertialSample SampleBetween(const InertialSample& a,
                             const InertialSample& b,
                             std::int64_t stamp_ns);

}  // namespace plumbline
