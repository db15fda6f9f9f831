// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/inertial/inertial_sample.h"

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix15d = Eigen::Matrix<double, 15, 15>;

// The motion of an inertial sensor between two stamps i and j of its clock as its samples tell it,
// without gravity and without the velocity at i (Forster et al., On-Manifold Preintegration, TRO
// 2017). With R_i, v_i, p_i the pose and velocity of the sensor in a world with gravity g:
//
//   R_j = R_i rotation
//   v_j = v_i + g duration + R_i velocity
//   p_j = p_i + v_i duration + g duration^2 / 2 + R_i position
//
// Tangents are [rotation, velocity, position], the rotation from the right: the true one is
// rotation Exp(w).
struct Preintegral {
  double duration = 0;                                           // seconds
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // i_from_j
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            // m/s, along the axes of i
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            // m, along the axes of i
  InertialBias bias;                                             // that it was computed with
  // Derivative by the bias at i, [gyroscope, accelerometer].
  Eigen::Matrix<double, 9, 6> by_bias = Eigen::Matrix<double, 9, 6>::Zero();
  // Derivative by a shift of both stamps i and j, per second: by the time offset of the sensor.
  Vector9d by_time_offset = Vector9d::Zero();
  // Covariance of [tangent, change of the gyroscope's and of the accelerometer's bias from i to j]
  // by white noise and walking biases, for a bias at i that is exact.
  Matrix15d covariance = Matrix15d::Zero();
};

// Integrates samples from one stamp to a later one, in nanoseconds of the sensor's clock.
//
// Rates and forces are linear between samples, and interpolated at both stamps. A step turns by the
// exponential of the mean rate and the second term of Magnus' series (coning); the forces at its
// two ends, turned by the rotations there, are linear in it, too. Error without noise: of second
// order in the sample interval.
//
// White noise grows over gaps: it is multiplied by step / (median interval of the samples), as one
// sample stands for the gap. Where a sample reaches the range of the sensor, the deviation of its
// noise is 100 times as large.
//
// The stamps of `samples` must increase strictly. Returns nullopt unless from_ns < to_ns and
// samples at or before from_ns and at or after to_ns are there. Cost: some microseconds a
// sample.
std::optional<Preintegral> Preintegrate(std::span<const InertialSample> samples,
                                        std::int64_t from_ns,
                                        std::int64_t to_ns,
                                        const InertialBias& bias,
                                        const InertialNoise& noise,
                                        const InertialRange& range = {});

// Returns the preintegral at another bias, to first order. Its derivatives and its covariance stay
// those of the former bias. The error is of second order: for 1 s, biases that differ by 0.01 rad/s
// and 0.27 m/s^2 and a hand's motion below 1e-4 rad, 2 mm/s and 1 mm.
Preintegral WithBias(const Preintegral& preintegral, const InertialBias& bias);

}  // namespace plumbline
