// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <limits>
#include <optional>

namespace plumbline {

// Noise of an inertial sensor as continuous-time densities, in the units of Kalibr, EuRoC and
// OpenVINS. The defaults are EuRoC's (ADIS16448).
struct InertialNoise {
  double gyroscope_noise_density = 1.6968e-4;   // rad/s/sqrt(Hz)
  double gyroscope_random_walk = 1.9393e-5;     // rad/s^2/sqrt(Hz)
  double accelerometer_noise_density = 2.0e-3;  // m/s^2/sqrt(Hz)
  double accelerometer_random_walk = 3.0e-3;    // m/s^3/sqrt(Hz)
};

// Largest magnitude that an axis can measure; infinite if unknown.
struct InertialRange {
  double gyroscope = std::numeric_limits<double>::infinity();      // rad/s
  double accelerometer = std::numeric_limits<double>::infinity();  // m/s^2
};

// What is known of an inertial sensor that is fixed to the left camera; nullopt what is not.
struct InertialCalibration {
  std::optional<Rigid3> imu_from_left;  // left camera as delivered, before rectification
  std::optional<InertialNoise> noise;
  InertialRange range;
  // Seconds: stamp of the sensor's clock = stamp of the camera's clock + time_offset, the sign of
  // Kalibr's timeshift_cam_imu.
  std::optional<double> time_offset;
  std::optional<double> rate_hz;  // nominal samples per second
};

}  // namespace plumbline
