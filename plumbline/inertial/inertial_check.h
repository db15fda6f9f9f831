// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/inertial/inertial_samples.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// What the samples of an inertial sensor tell about it, without any image.
struct InertialCheck {
  std::size_t samples = 0;
  double seconds = 0;  // from the first to the last one
  double rate_hz = 0;  // by the median interval; 0 of less than two samples
  // Seconds that 95 % of the intervals that are no gaps are at most off the median.
  double jitter = 0;
  std::size_t gaps = 0;                               // intervals above 1.5 medians
  double longest_gap = 0;                             // seconds
  std::size_t backward = 0, repeated = 0, ahead = 0;  // left out, as of OrderedSamples
  // Samples with an axis at the range that the calibration tells, or else at the largest magnitude
  // of all, if three samples or more in a row have exactly this.
  std::size_t saturated_rates = 0, saturated_forces = 0;
  double largest_rate = 0, largest_force = 0;  // of one axis, rad/s and m/s^2
  double median_force = 0;                     // magnitude, m/s^2

  // Seconds in which the sensor rests: for each of them the deviations of rate and force from their
  // means are below 0.02 rad/s and 0.2 m/s^2, and the mean rate is below 0.1 rad/s.
  double rest_seconds = 0;
  // White noise at rest by differences of neighbouring samples, as densities, and the mean rate,
  // the bias of the gyroscope. Meaningful if rest_seconds > 0. Where a sensor smooths its samples
  // they are too small.
  double gyroscope_noise_density = 0, accelerometer_noise_density = 0;
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();

  // Units that cannot be.
  bool rates_in_degrees = false, forces_in_g = false, gravity_taken_off = false;
};

// Looks at samples as delivered.
//
// Degrees for radians: the direction of the force, mostly gravity, turns against that of the sensor
// by the integrated rates. Over steps of 0.5 s the rates, read as degrees, must explain it with a
// quarter of the squared error that they have as radians, and some rate must be above 8. g for
// m/s^2: the median force is 0.7 to 1.3, its quartiles within 30 % of it; else, below 5 m/s^2,
// gravity was taken off.
//
// Cost: O(samples log samples), 0.2 us a sample.
InertialCheck CheckInertial(const OrderedSamples& ordered, const InertialCalibration& calibration);

// Returns one sentence for each thing of a check that is wrong: gaps, stamps, range, units, and
// noise at rest that is not within a factor of 3 of that of the calibration.
std::vector<std::string> InertialFaults(const InertialCheck& check,
                                        const InertialCalibration& calibration);

}  // namespace plumbline
