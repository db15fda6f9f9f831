// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/path.h"

#include "plumbline/synth/noise.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace plumbline {

HandHeldLoop::HandHeldLoop(const Shape& shape) : shape_(shape) {}

double HandHeldLoop::Wander(double time, int channel, int first_period, double size) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double phase = 2 * std::numbers::pi * UnitFromHash(HashCell(channel, i, shape_.seed));
    const double turns = (first_period * (i + 1) + i) * time / shape_.loop_s;
    sum += size / (1 + i) * std::sin(2 * std::numbers::pi * turns + phase);
  }
  return sum;
}

Rigid3 HandHeldLoop::WorldFromCamera(double time) const {
  const double turn = 2 * std::numbers::pi * time / shape_.loop_s;
  // About 1.7 steps a second; an even number in a loop, for the roll goes left and right.
  const double steps = 2 * std::round(0.5 * 1.7 * shape_.loop_s);
  const double gait = steps * turn;
  Eigen::Vector3d position = shape_.centre;
  position.x() += shape_.radius_x * std::cos(turn) + Wander(time, 0, 2, 0.03);
  position.y() += shape_.radius_y * std::sin(turn) + Wander(time, 1, 2, 0.03);
  position.z() += Wander(time, 2, 2, 0.08) + 0.006 * std::sin(gait);

  const double yaw = turn + 0.5 + Wander(time, 3, 2, 0.08);
  const double pitch = 0.14 + Wander(time, 4, 2, 0.06) + 0.003 * std::sin(gait + 1);  // downwards
  const double roll = Wander(time, 5, 3, 0.03) + 0.003 * std::sin(0.5 * gait + 2);
  const Eigen::Vector3d forward(
      std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), -std::sin(pitch));
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  const Eigen::Quaterniond level(axes);
  const Eigen::Quaterniond rolled =
      level * Eigen::Quaterniond(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
  return {rolled.normalized(), position};
}

}  // namespace plumbline
