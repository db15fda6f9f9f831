// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// What real inertial sensors and their drivers do beside noise; each is nothing by default.
struct ImuFaults {
  double bias = 0;         // turn-on biases: times 0.05 rad/s and 0.1 m/s^2 (deviation of an axis)
  bool average = false;    // a sample is the mean over its interval, not an instant
  double offset_ms = 0;    // stamps are those of the cameras' clock plus this
  double jitter_ms = 0;    // stamps are off by up to this, evenly
  double gap_ms = 0;       // without samples, once in two seconds
  double lost = 0;         // share of samples, one by one
  double rate_range = 0;   // rad/s that the gyroscope measures at most; 0: no limit
  double force_range = 0;  // m/s^2 that the accelerometer measures at most; 0: no limit
  double axes = 0;         // scale and angles of the axes: times 0.5 % and 0.3 degrees (deviation)
  double margin_s = 0;     // samples before the first and after the last frame
};

template <class Visitor>
void VisitFields(Visitor&& visit, ImuFaults& o) {
  visit("bias", o.bias, "turn-on biases, 1: of 0.05 rad/s and 0.1 m/s^2", Range{0, 100});
  visit("average", o.average, "samples are means over their interval, not instants");
  visit("offset_ms", o.offset_ms, "its clock minus that of the cameras", Range{-1000, 1000});
  visit("jitter_ms", o.jitter_ms, "stamps are off by up to this", Range{0, 100});
  visit("gap_ms", o.gap_ms, "without samples, once in two seconds", Range{0, 1900});
  visit("lost", o.lost, "share of samples that are lost", Range{0, 0.9});
  visit("rate_range", o.rate_range, "most of an axis [rad/s], 0: no limit", Range{0, 1000});
  visit("force_range", o.force_range, "most of an axis [m/s^2], 0: no limit", Range{0, 10000});
  visit("axes", o.axes, "scales and angles of axes, 1: 0.5 % and 0.3 degrees", Range{0, 20});
  visit("margin_s", o.margin_s, "samples before the first and after the last frame", Range{0, 60});
}

// Errors of an inertial sensor, continuous-time densities; the values of EuRoC's ADIS16448.
struct ImuModel {
  double gyroscope_density = 1.6968e-4;   // rad / s / sqrt(Hz)
  double gyroscope_walk = 1.9393e-5;      // rad / s^2 / sqrt(Hz)
  double accelerometer_density = 2.0e-3;  // m / s^2 / sqrt(Hz)
  double accelerometer_walk = 3.0e-3;     // m / s^3 / sqrt(Hz)
  double rate_hz = 200;
  ImuFaults faults;
};

struct ImuSample {
  double time = 0;                                           // seconds
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();    // rad / s, body frame
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  // m / s^2, body frame
};

struct ImuRecording {
  std::vector<ImuSample> ideal;   // instants, without faults
  std::vector<ImuSample> noisy;   // as delivered: ideal + bias + noise, with the faults
  std::vector<ImuSample> biases;  // slowly varying part of the errors, at the times of `ideal`
};

// Returns the measurements of an inertial sensor in the body on a path, from 0 to `duration`
// seconds and faults.margin_s beyond: rates and accelerations by central differences over 2 ms,
// gravity 9.81 m/s^2 down the world's z axis. `noise` multiplies the errors of the densities.
ImuRecording RecordImu(const std::function<Rigid3(double)>& world_from_body,
                       double duration,
                       const ImuModel& model,
                       double noise,
                       std::uint64_t seed);

}  // namespace plumbline
