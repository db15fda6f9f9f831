// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace plumbline {

// A measurement of an inertial sensor, in the sensor's own frame.
struct InertialSample {
  std::int64_t stamp_ns = 0;                                 // the sensor's clock
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();    // rad/s
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  // m/s^2: acceleration minus gravity
};

// Constant errors of an inertial sensor: measurement = truth + bias + noise.
struct InertialBias {
  Eigen::Vector3d gyroscope = Eigen::Vector3d::Zero();      // rad/s
  Eigen::Vector3d accelerometer = Eigen::Vector3d::Zero();  // m/s^2
};

}  // namespace plumbline
