// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Errors of an inertial sensor, continuous-time densities; the values of EuRoC's ADIS16448.
struct ImuModel {
  double gyroscope_density = 1.6968e-4;   // rad / s / sqrt(Hz)
  double gyroscope_walk = 1.9393e-5;      // rad / s^2 / sqrt(Hz)
  double accelerometer_density = 2.0e-3;  // m / s^2 / sqrt(Hz)
  double accelerometer_walk = 3.0e-3;     // m / s^3 / sqrt(Hz)
  double rate_hz = 200;
};

struct ImuSample {
  double time = 0;                                           // seconds
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();    // rad / s, body frame
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  // m / s^2, body frame
};

struct ImuRecording {
  std::vector<ImuSample> ideal;
  std::vector<ImuSample> noisy;   // ideal + bias + noise
  std::vector<ImuSample> biases;  // slowly varying part of the errors
};

// Returns the measurements of an inertial sensor in the body on a path, from 0 to `duration`
// seconds: rates and accelerations by central differences over 2 ms, gravity 9.81 m/s^2 down the
// world's z axis. `noise` multiplies all errors.
ImuRecording RecordImu(const std::function<Rigid3(double)>& world_from_body,
                       double duration,
                       const ImuModel& model,
                       double noise,
                       std::uint64_t seed);

}  // namespace plumbline
