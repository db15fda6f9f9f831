// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/gyroscope.h"

#include "plumbline/base/error.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/inertial/inertial_samples.h"
#include "plumbline/inertial/preintegration.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kKept = 20;          // seconds of samples
constexpr double kLate = 0.02;        // seconds that the newest sample may be held
constexpr double kLongestGap = 0.15;  // seconds
// Deviations before the first observation.
constexpr double kBias = 0.1;  // rad/s, that of sensors when they are turned on
constexpr double kPlace = 3 * kDegree;
constexpr double kClock = 0.003, kUnknownClock = 0.01;  // seconds
// The least deviation of a rotation that a camera and its map tell.
constexpr double kLeastRotation = 1e-3;  // radians
// Axes that are not quite square and scales, relative to the turn.
constexpr double kAxes = 0.005;
// Second derivative of a hand's rates: what a straight line over a gap misses [rad/s^3].
constexpr double kBend = 150;
// Random walks of place and clock.
constexpr double kPlaceWalk = 1e-4;  // radians / sqrt(s)
constexpr double kClockWalk = 1e-4;  // seconds / sqrt(s)

double Squared(double x) { return x * x; }

// True if three samples in a row hold exactly one large rate on an axis.
bool IsClipped(std::span<const InertialSample> samples, double range) {
  constexpr double kSlow = 1;  // rad/s; below, equal rates are those of a coarse scale
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double rate = samples[i].angular_rate[axis];
      if (std::abs(rate) >= range) return true;
      if (i + 2 < samples.size() && std::abs(rate) > kSlow &&
          rate == samples[i + 1].angular_rate[axis] && rate == samples[i + 2].angular_rate[axis]) {
        return true;
      }
    }
  }
  return false;
}

// Variance of the turn that is missed over gaps; nullopt if one is too long.
std::optional<double> MissedOver(std::span<const InertialSample> samples) {
  const double usual = MedianInterval(samples);
  double variance = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step =
        static_cast<double>(samples[i].stamp_ns - samples[i - 1].stamp_ns) / kNsPerSecond;
    if (step > kLongestGap) return std::nullopt;
    if (step > 1.5 * usual) variance += Squared(kBend / 12 * step * step * step);
  }
  return variance;
}

}  // namespace

Gyroscope::Gyroscope(const InertialCalibration& calibration,
                     const Eigen::Quaterniond& rectified_from_left)
    : noise_(calibration.noise.value_or(InertialNoise{})),
      range_(calibration.range),
      time_offset_(calibration.time_offset.value_or(0)) {
  PLUMBLINE_CHECK(calibration.imu_from_left.has_value(), "a gyroscope at an unknown place");
  imu_from_camera_ =
      (calibration.imu_from_left->rotation * rectified_from_left.conjugate()).normalized();
  const double clock = calibration.time_offset ? kClock : kUnknownClock;
  covariance_.diagonal() << Vector3d::Constant(Squared(kBias)), Vector3d::Constant(Squared(kPlace)),
      Squared(clock);
}

void Gyroscope::Add(std::span<const InertialSample> samples) {
  for (const InertialSample& sample : samples) {
    if (samples_.empty() || sample.stamp_ns > samples_.back().stamp_ns) samples_.push_back(sample);
  }
  if (samples_.empty()) return;
  const auto oldest = samples_.back().stamp_ns - static_cast<std::int64_t>(kKept * kNsPerSecond);
  // Samples of twice the time are collected before any are moved.
  if (samples_.front().stamp_ns > oldest - (samples_.back().stamp_ns - oldest)) return;
  std::erase_if(samples_, [oldest](const InertialSample& s) { return s.stamp_ns < oldest; });
}

// Returns the samples from the last one at or before a stamp to the first one at or after another.
// The newest one is held where it is late.
std::vector<InertialSample> Gyroscope::Between(std::int64_t from_ns, std::int64_t to_ns) const {
  const auto later = [](std::int64_t stamp, const InertialSample& s) { return stamp < s.stamp_ns; };
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), from_ns, later);
  if (after == samples_.begin()) return {};
  const auto end = std::lower_bound(
      after, samples_.end(), to_ns, [](const InertialSample& s, std::int64_t stamp) {
        return s.stamp_ns < stamp;
      });
  std::vector<InertialSample> between(after - 1, end == samples_.end() ? end : end + 1);
  if (between.back().stamp_ns < to_ns) {
    const auto late = static_cast<double>(to_ns - between.back().stamp_ns) / kNsPerSecond;
    if (late > kLate) return {};
    between.push_back(between.back());
    between.back().stamp_ns = to_ns;
  }
  return between;
}

std::optional<CameraTurn> Gyroscope::Turn(std::int64_t from_ns, std::int64_t to_ns) const {
  const auto offset =
      static_cast<std::int64_t>(std::llround((time_offset_ + errors_[6]) * kNsPerSecond));
  const std::vector<InertialSample> samples = Between(from_ns + offset, to_ns + offset);
  if (samples.size() < 2 || IsClipped(samples, range_.gyroscope)) return std::nullopt;
  const auto missed = MissedOver(samples);
  if (!missed) return std::nullopt;
  const InertialBias bias{errors_.head<3>(), Vector3d::Zero()};
  const auto sensor = Preintegrate(samples, from_ns + offset, to_ns + offset, bias, noise_);
  if (!sensor) return std::nullopt;
  // The sensor's rotation is perturbed from the right, which of its inverse is the left.
  const Eigen::Quaterniond camera_from_imu =
      (ExpSo3(errors_.segment<3>(3)) * imu_from_camera_.conjugate()).normalized();
  const Matrix3d C = camera_from_imu.toRotationMatrix();
  CameraTurn turn;
  turn.b_from_a =
      (camera_from_imu * sensor->rotation.conjugate() * camera_from_imu.conjugate()).normalized();
  turn.by_errors.leftCols<3>() = -C * sensor->by_bias.topLeftCorner<3, 3>();
  // Exp(p) R Exp(-p) = Exp(p - R p) R.
  turn.by_errors.middleCols<3>(3) = Matrix3d::Identity() - turn.b_from_a.toRotationMatrix();
  turn.by_errors.col(6) = -C * sensor->by_time_offset.head<3>();
  const double angle = LogSo3(turn.b_from_a).norm();
  turn.noise = C * sensor->covariance.topLeftCorner<3, 3>() * C.transpose();
  turn.noise.diagonal().array() += *missed + Squared(kAxes * angle) + Squared(kLeastRotation);
  turn.covariance = turn.noise + turn.by_errors * covariance_ * turn.by_errors.transpose();
  return turn;
}

void Gyroscope::Observe(const CameraTurn& turn,
                        const Eigen::Quaterniond& b_from_a,
                        const Matrix3d& covariance,
                        double seconds) {
  const Vector3d residual = LogSo3(b_from_a * turn.b_from_a.conjugate());
  const Matrix3d S = turn.covariance + covariance;
  const Eigen::LLT<Matrix3d> llt(S);
  if (llt.info() != Eigen::Success) return;
  Judge(residual.dot(llt.solve(residual)));
  Learn(turn, llt.solve(Matrix3d::Identity()), residual, S, seconds);
}

void Gyroscope::ObserveChange(const CameraTurn& turn,
                              const Matrix3d& predicted,
                              const Vector3d& change,
                              const Matrix3d& estimated,
                              double seconds) {
  // The camera's own measurement is what takes the prediction to the estimate.
  Matrix3d known = estimated;
  known.diagonal().array() += Squared(kLeastRotation);
  const Matrix3d innovation = predicted - known;
  const Eigen::LLT<Matrix3d> of_innovation(innovation);
  const Eigen::LLT<Matrix3d> of_predicted(predicted);
  if (of_innovation.info() != Eigen::Success || of_predicted.info() != Eigen::Success) return;
  Judge(change.dot(of_innovation.solve(change)));
  Learn(turn, of_predicted.solve(Matrix3d::Identity()), change, innovation, seconds);
}

void Gyroscope::Learn(const CameraTurn& turn,
                      const Matrix3d& weight,
                      const Vector3d& change,
                      const Matrix3d& innovation,
                      double seconds) {
  const Eigen::Matrix<double, 7, 3> gain = covariance_ * turn.by_errors.transpose() * weight;
  errors_ += gain * change;
  covariance_ -= gain * innovation * gain.transpose();
  Grow(seconds);
}

// Keeps the mean contradiction of the last turns: the first ones count alike, so that one turn in
// the wrong direction is enough at the start.
void Gyroscope::Judge(double chi2) {
  constexpr double kMost = 9, kAgain = 4;
  constexpr double kTurns = 30;
  constexpr double kDegrees = 3;
  const double weight = 1 / std::min(kTurns, static_cast<double>(++observed_));
  // One turn with a wrong pose of the camera tells nothing of the sensor.
  constexpr double kWorst = 100;
  contradiction_ += weight * (std::min(chi2 / kDegrees, kWorst) - contradiction_);
  agrees_ = contradiction_ < (agrees_ ? kMost : kAgain);
  contradicted_ += !agrees_;
}

void Gyroscope::Grow(double seconds) {
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  const double bias = Squared(noise_.gyroscope_random_walk) * seconds;
  covariance_.diagonal() += (GyroscopeErrors() << Vector3d::Constant(bias),
                             Vector3d::Constant(Squared(kPlaceWalk) * seconds),
                             Squared(kClockWalk) * seconds)
                                .finished();
}

}  // namespace plumbline
