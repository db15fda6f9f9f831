// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_preintegration.h"

#include "plumbline/base/units.h"

#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/jet.h>
#include <ceres/rotation.h>

namespace plumbline {
namespace {

using Jet = ceres::Jet<double, 7>;  // gyroscope's bias, accelerometer's bias, time offset
using JetVector = Eigen::Matrix<Jet, 3, 1>;

JetVector Without(const Eigen::Vector3d& bias, const JetVector& measured, int first_derivative) {
  JetVector result;
  for (int k = 0; k < 3; ++k) result(k) = measured(k) - Jet(bias(k), first_derivative + k);
  return result;
}

Eigen::Quaternion<Jet> Exp(const JetVector& turn) {
  Jet wxyz[4];
  ceres::AngleAxisToQuaternion(turn.data(), wxyz);
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

struct Corrected {
  JetVector rate, force;
};

Corrected At(const InertialSample& a,
             const InertialSample& b,
             const Jet& share,
             const InertialBias& bias) {
  const auto mix = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
    return JetVector((Jet(1) - share) * x.cast<Jet>() + share * y.cast<Jet>());
  };
  return {Without(bias.gyroscope, mix(a.angular_rate, b.angular_rate), 0),
          Without(bias.accelerometer, mix(a.specific_force, b.specific_force), 3)};
}

}  // namespace

Preintegral PreintegrateByJets(std::span<const InertialSample> samples,
                               std::int64_t from_ns,
                               std::int64_t to_ns,
                               const InertialBias& bias) {
  const auto seconds = [&](std::int64_t ns) { return static_cast<double>(ns - from_ns) / 1e9; };
  const Jet from(0, 6), to(seconds(to_ns), 6);
  Eigen::Quaternion<Jet> R = Eigen::Quaternion<Jet>::Identity();
  JetVector v = JetVector::Zero(), p = JetVector::Zero();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const InertialSample &a = samples[i - 1], &b = samples[i];
    if (b.stamp_ns <= from_ns || a.stamp_ns >= to_ns) continue;
    const Jet begin = a.stamp_ns <= from_ns ? from : Jet(seconds(a.stamp_ns));
    const Jet end = b.stamp_ns >= to_ns ? to : Jet(seconds(b.stamp_ns));
    const Jet start(seconds(a.stamp_ns)), length(seconds(b.stamp_ns) - seconds(a.stamp_ns));
    const Corrected first = At(a, b, (begin - start) / length, bias);
    const Corrected second = At(a, b, (end - start) / length, bias);
    const Jet dt = end - begin;
    const JetVector turn = dt * Jet(0.5) * (first.rate + second.rate) +
                           dt * dt / Jet(12) * first.rate.cross(second.rate);
    const JetVector f0 = R * first.force;
    R = R * Exp(turn);
    const JetVector f1 = R * second.force;
    p += dt * v + dt * dt * (f0 / Jet(3) + f1 / Jet(6));
    v += dt * Jet(0.5) * (f0 + f1);
  }
  Preintegral result;
  result.duration = seconds(to_ns);
  result.bias = bias;
  result.rotation = Eigen::Quaterniond(R.w().a, R.x().a, R.y().a, R.z().a);
  const Eigen::Quaternion<Jet> around = result.rotation.conjugate().cast<Jet>() * R;
  Eigen::Matrix<Jet, 9, 1> tangent;
  tangent << Jet(2) * around.vec(), v, p;
  for (int row = 0; row < 9; ++row) {
    result.by_bias.row(row) = tangent(row).v.head<6>().transpose();
    result.by_time_offset(row) = tangent(row).v(6);
  }
  for (int k = 0; k < 3; ++k) {
    result.velocity(k) = v(k).a;
    result.position(k) = p(k).a;
  }
  return result;
}

}  // namespace plumbline
