// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/preintegration.h"

#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/inertial/inertial_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) / kNsPerSecond; }

// Variance of the noise of a step against that of two good neighbouring samples.
double NoiseFactor(const Vector3d& a, const Vector3d& b, double range, double gap) {
  constexpr double kSaturated = 100;  // deviation of the noise of a clipped sample
  const double most = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  return std::max(1.0, gap) * (most >= range ? kSaturated * kSaturated : 1.0);
}

// One step between two samples that are apart by dt, with the bias taken off.
struct Step {
  Vector3d rate0 = Vector3d::Zero(), rate1 = Vector3d::Zero();
  Vector3d force0 = Vector3d::Zero(), force1 = Vector3d::Zero();
  double dt = 0;
  double gyroscope_factor = 1, accelerometer_factor = 1;  // variances
};

class Integrator {
 public:
  explicit Integrator(const InertialNoise& noise) : noise_(noise) {}

  void Take(const Step& step) {
    const double dt = step.dt;
    const Vector3d turn =
        0.5 * dt * (step.rate0 + step.rate1) + dt * dt / 12 * step.rate0.cross(step.rate1);
    const Eigen::Quaterniond increment = ExpSo3(turn);
    const Matrix3d R0 = result_.rotation.toRotationMatrix();
    const Eigen::Quaterniond end = (result_.rotation * increment).normalized();
    const Matrix3d R1 = end.toRotationMatrix();
    Carry(step, increment, LeftJacobianSo3(-turn), R0, R1);
    const Vector3d f0 = R0 * step.force0, f1 = R1 * step.force1;
    result_.position += dt * result_.velocity + dt * dt * (f0 / 3 + f1 / 6);
    result_.velocity += 0.5 * dt * (f0 + f1);
    result_.rotation = end;
    result_.duration += dt;
  }

  Preintegral result() const {
    Preintegral result = result_;
    result.by_bias = by_bias_;
    return result;
  }

 private:
  // Carries derivatives and covariance over a step: x1 = A x0 + B b for the tangent x and the bias
  // b at the step's start.
  void Carry(const Step& step,
             const Eigen::Quaterniond& increment,
             const Matrix3d& right_jacobian,
             const Matrix3d& R0,
             const Matrix3d& R1) {
    const double dt = step.dt;
    const Matrix3d E = increment.conjugate().toRotationMatrix();
    const Matrix3d turn_by_bias =
        right_jacobian * (dt * dt / 12 * Skew(step.rate1 - step.rate0) - dt * Matrix3d::Identity());
    const Matrix3d f0_by_turn = -R0 * Skew(step.force0), f1_by_turn = -R1 * Skew(step.force1);
    Eigen::Matrix<double, 9, 9> A = Eigen::Matrix<double, 9, 9>::Identity();
    A.block<3, 3>(0, 0) = E;
    A.block<3, 3>(3, 0) = 0.5 * dt * (f0_by_turn + f1_by_turn * E);
    A.block<3, 3>(6, 0) = dt * dt * (f0_by_turn / 3 + f1_by_turn * E / 6);
    A.block<3, 3>(6, 3).diagonal().setConstant(dt);
    Eigen::Matrix<double, 9, 6> B;
    B << turn_by_bias, Matrix3d::Zero(),                              //
        0.5 * dt * f1_by_turn * turn_by_bias, -0.5 * dt * (R0 + R1),  //
        dt * dt / 6 * f1_by_turn * turn_by_bias, -dt * dt * (R0 / 3 + R1 / 6);
    by_bias_ = A * by_bias_ + B;
    CarryCovariance(step, A, B, R1);
  }

  void CarryCovariance(const Step& step,
                       const Eigen::Matrix<double, 9, 9>& A,
                       const Eigen::Matrix<double, 9, 6>& B,
                       const Matrix3d& R1) {
    const double dt = step.dt;
    Matrix15d F = Matrix15d::Identity();
    F.topLeftCorner<9, 9>() = A;
    F.topRightCorner<9, 6>() = B;
    const auto squared = [](double x) { return x * x; };
    const double gyroscope = squared(noise_.gyroscope_noise_density) * step.gyroscope_factor;
    const double accelerometer =
        squared(noise_.accelerometer_noise_density) * step.accelerometer_factor;
    // White noise over the step; what the turn of this step does to its own force is of higher
    // order. The noise is the same along all axes, so that rotations leave it.
    const Matrix3d I = Matrix3d::Identity();
    Matrix15d Q = Matrix15d::Zero();
    Q.block<3, 3>(0, 0) = gyroscope * dt * I;
    Q.block<3, 3>(3, 3) = accelerometer * dt * I;
    Q.block<3, 3>(3, 6) = Q.block<3, 3>(6, 3) = accelerometer * dt * dt / 2 * I;
    Q.block<3, 3>(6, 6) = accelerometer * dt * dt * dt / 3 * I;
    // Biases that walk: their integrals over the step, too.
    const double gyroscope_walk = squared(noise_.gyroscope_random_walk);
    const double accelerometer_walk = squared(noise_.accelerometer_random_walk);
    Q.block<3, 3>(0, 0) += gyroscope_walk * dt * dt * dt / 3 * I;
    Q.block<3, 3>(0, 9) = -gyroscope_walk * dt * dt / 2 * I;
    Q.block<3, 3>(3, 3) += accelerometer_walk * dt * dt * dt / 3 * I;
    Q.block<3, 3>(3, 12) = -accelerometer_walk * dt * dt / 2 * R1;
    Q.block<3, 3>(9, 0) = Q.block<3, 3>(0, 9).transpose();
    Q.block<3, 3>(12, 3) = Q.block<3, 3>(3, 12).transpose();
    Q.block<3, 3>(9, 9) = gyroscope_walk * dt * I;
    Q.block<3, 3>(12, 12) = accelerometer_walk * dt * I;
    result_.covariance = F * result_.covariance * F.transpose() + Q;
  }

  const InertialNoise noise_;
  Preintegral result_;
  Eigen::Matrix<double, 9, 6> by_bias_ = Eigen::Matrix<double, 9, 6>::Zero();
};

// The motion between stamps that both move on: the end adds what is measured there, the start takes
// off what is measured there and turns the rest.
Vector9d ByTimeOffset(const Preintegral& preintegral, const Step& first, const Step& last) {
  const Vector3d &rate = first.rate0, &force = first.force0;
  Vector9d derivative;
  derivative << last.rate1 - preintegral.rotation.conjugate() * rate,
      preintegral.rotation * last.force1 - force - rate.cross(preintegral.velocity),
      preintegral.velocity - preintegral.duration * force - rate.cross(preintegral.position);
  return derivative;
}

}  // namespace

std::optional<Preintegral> Preintegrate(std::span<const InertialSample> samples,
                                        std::int64_t from_ns,
                                        std::int64_t to_ns,
                                        const InertialBias& bias,
                                        const InertialNoise& noise,
                                        const InertialRange& range) {
  if (samples.size() < 2 || from_ns >= to_ns) return std::nullopt;
  if (samples.front().stamp_ns > from_ns || samples.back().stamp_ns < to_ns) return std::nullopt;
  const double interval = MedianInterval(samples);
  Integrator integrator(noise);
  std::optional<Step> first;
  Step step;
  const auto after = std::upper_bound(
      samples.begin(), samples.end(), from_ns, [](std::int64_t stamp, const InertialSample& s) {
        return stamp < s.stamp_ns;
      });
  for (auto next = after; next != samples.end(); ++next) {
    const InertialSample &a = *(next - 1), &b = *next;
    if (a.stamp_ns >= to_ns) break;
    const InertialSample begin = SampleBetween(a, b, std::max(a.stamp_ns, from_ns));
    const InertialSample end = SampleBetween(a, b, std::min(b.stamp_ns, to_ns));
    const double gap = Seconds(b.stamp_ns - a.stamp_ns) / interval;
    step.rate0 = begin.angular_rate - bias.gyroscope;
    step.rate1 = end.angular_rate - bias.gyroscope;
    step.force0 = begin.specific_force - bias.accelerometer;
    step.force1 = end.specific_force - bias.accelerometer;
    step.dt = Seconds(end.stamp_ns - begin.stamp_ns);
    step.gyroscope_factor = NoiseFactor(a.angular_rate, b.angular_rate, range.gyroscope, gap);
    step.accelerometer_factor =
        NoiseFactor(a.specific_force, b.specific_force, range.accelerometer, gap);
    integrator.Take(step);
    if (!first) first = step;
  }
  Preintegral result = integrator.result();
  result.bias = bias;
  result.by_time_offset = ByTimeOffset(result, *first, step);
  return result;
}

Preintegral WithBias(const Preintegral& preintegral, const InertialBias& bias) {
  Vector6d change;
  change << bias.gyroscope - preintegral.bias.gyroscope,
      bias.accelerometer - preintegral.bias.accelerometer;
  const Vector9d tangent = preintegral.by_bias * change;
  Preintegral moved = preintegral;
  moved.rotation = (preintegral.rotation * ExpSo3(tangent.head<3>())).normalized();
  moved.velocity += tangent.segment<3>(3);
  moved.position += tangent.tail<3>();
  moved.bias = bias;
  return moved;
}

}  // namespace plumbline
