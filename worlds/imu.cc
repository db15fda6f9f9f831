// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/imu.h"

#include "plumbline/base/units.h"
#include "worlds/noise.h"

#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

using Eigen::Vector3d;

// Channels of random numbers beyond those of Normals, which takes three for each of its own.
constexpr int kLossChannel = 100, kJitterChannel = 101;

ImuSample Ideal(const std::function<Rigid3(double)>& world_from_body, double time) {
  constexpr double kStep = 1e-3;
  const Vector3d gravity(0, 0, -9.81);
  const Rigid3 before = world_from_body(time - kStep), now = world_from_body(time);
  const Rigid3 after = world_from_body(time + kStep);
  const Vector3d acceleration =
      (after.translation - 2 * now.translation + before.translation) / (kStep * kStep);
  return {time,
          LogSo3(before.rotation.conjugate() * after.rotation) / (2 * kStep),
          now.rotation.conjugate() * (acceleration - gravity)};
}

Vector3d Normals(std::size_t sample, int channel, std::uint64_t seed) {
  Vector3d normals;
  for (int k = 0; k < 3; ++k) {
    normals(k) = static_cast<double>(
        NormalFromHash(HashCell(static_cast<std::int64_t>(sample), 3 * channel + k, seed)));
  }
  return normals;
}

// The mean over the interval around a time, of eight instants.
ImuSample Averaged(const std::function<Rigid3(double)>& world_from_body,
                   double time,
                   double interval) {
  constexpr int kInstants = 8;
  ImuSample mean;
  mean.time = time;
  for (int k = 0; k < kInstants; ++k) {
    const double at = time + interval * ((k + 0.5) / kInstants - 0.5);
    const ImuSample instant = Ideal(world_from_body, at);
    mean.angular_rate += instant.angular_rate / kInstants;
    mean.specific_force += instant.specific_force / kInstants;
  }
  return mean;
}

// Rows are the axes of the sensor, with their scales.
Eigen::Matrix3d Axes(double faults, int channel, std::uint64_t seed) {
  constexpr double kScale = 0.005, kAngle = 0.3 * kDegree;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    axes.row(row) += faults * kAngle * Normals(static_cast<std::size_t>(row), channel, seed);
    axes(row, row) = 1 + faults * kScale * Normals(3, channel, seed)(row);
  }
  return axes;
}

Vector3d Clipped(const Vector3d& value, double range) {
  return range > 0 ? Vector3d(value.cwiseMax(-range).cwiseMin(range)) : value;
}

// True if the sample does not arrive.
bool IsLost(const ImuFaults& faults, std::size_t sample, double time, std::uint64_t seed) {
  constexpr double kPeriod = 2;  // seconds from gap to gap, the first in the middle
  const double in_period = time / kPeriod - std::floor(time / kPeriod);
  if (std::abs(in_period - 0.5) * kPeriod < 0.5e-3 * faults.gap_ms) return true;
  const auto index = static_cast<std::int64_t>(sample);
  return UnitFromHash(HashCell(index, kLossChannel, seed)) < faults.lost;
}

double StampOf(const ImuFaults& faults, std::size_t sample, double time, std::uint64_t seed) {
  const auto index = static_cast<std::int64_t>(sample);
  const double jitter = 2 * UnitFromHash(HashCell(index, kJitterChannel, seed)) - 1;
  return time + 1e-3 * (faults.offset_ms + faults.jitter_ms * jitter);
}

}  // namespace

ImuRecording RecordImu(const std::function<Rigid3(double)>& world_from_body,
                       double duration,
                       const ImuModel& model,
                       double noise,
                       std::uint64_t seed) {
  const ImuFaults& faults = model.faults;
  const auto before = static_cast<std::int64_t>(std::floor(faults.margin_s * model.rate_hz));
  const auto count = static_cast<std::size_t>(std::floor(duration * model.rate_hz) + 1) +
                     2 * static_cast<std::size_t>(before);
  const double white = noise * std::sqrt(model.rate_hz), walk = noise / std::sqrt(model.rate_hz);
  const Eigen::Matrix3d rate_axes = Axes(faults.axes, 6, seed);
  const Eigen::Matrix3d force_axes = Axes(faults.axes, 7, seed);
  ImuRecording recording;
  ImuSample bias;
  bias.angular_rate = faults.bias * 0.05 * Normals(0, 4, seed);
  bias.specific_force = faults.bias * 0.1 * Normals(0, 5, seed);
  for (std::size_t i = 0; i < count; ++i) {
    const double time = static_cast<double>(static_cast<std::int64_t>(i) - before) / model.rate_hz;
    const ImuSample ideal = Ideal(world_from_body, time);
    bias.time = ideal.time;
    bias.angular_rate += walk * model.gyroscope_walk * Normals(i, 0, seed);
    bias.specific_force += walk * model.accelerometer_walk * Normals(i, 1, seed);
    recording.ideal.push_back(ideal);
    recording.biases.push_back(bias);
    if (IsLost(faults, i, time, seed)) continue;
    ImuSample noisy = faults.average ? Averaged(world_from_body, time, 1 / model.rate_hz) : ideal;
    noisy.time = StampOf(faults, i, time, seed);
    const Vector3d rate =
        rate_axes * noisy.angular_rate +
        (bias.angular_rate + white * model.gyroscope_density * Normals(i, 2, seed));
    const Vector3d force =
        force_axes * noisy.specific_force +
        (bias.specific_force + white * model.accelerometer_density * Normals(i, 3, seed));
    noisy.angular_rate = Clipped(rate, faults.rate_range);
    noisy.specific_force = Clipped(force, faults.force_range);
    recording.noisy.push_back(noisy);
  }
  return recording;
}

}  // namespace plumbline
