// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/imu.h"

#include "worlds/noise.h"

#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

using Eigen::Vector3d;

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

}  // namespace

ImuRecording RecordImu(const std::function<Rigid3(double)>& world_from_body,
                       double duration,
                       const ImuModel& model,
                       double noise,
                       std::uint64_t seed) {
  const auto count = static_cast<std::size_t>(std::floor(duration * model.rate_hz)) + 1;
  const double white = noise * std::sqrt(model.rate_hz), walk = noise / std::sqrt(model.rate_hz);
  ImuRecording recording;
  ImuSample bias;
  for (std::size_t i = 0; i < count; ++i) {
    const ImuSample ideal = Ideal(world_from_body, static_cast<double>(i) / model.rate_hz);
    bias.time = ideal.time;
    bias.angular_rate += walk * model.gyroscope_walk * Normals(i, 0, seed);
    bias.specific_force += walk * model.accelerometer_walk * Normals(i, 1, seed);
    ImuSample noisy = ideal;
    noisy.angular_rate += bias.angular_rate + white * model.gyroscope_density * Normals(i, 2, seed);
    noisy.specific_force +=
        bias.specific_force + white * model.accelerometer_density * Normals(i, 3, seed);
    recording.ideal.push_back(ideal);
    recording.noisy.push_back(noisy);
    recording.biases.push_back(bias);
  }
  return recording;
}

}  // namespace plumbline
