// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/rate_alignment.h"

#include "plumbline/base/units.h"
#include "plumbline/geometry/alignment.h"
#include "plumbline/geometry/symmetric_matrix.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace plumbline {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A stretch between two poses: times from the first sample, and the mean rate of the camera.
struct Turn {
  double from = 0, to = 0;
  Vector3d rate;
};

// The integral of the rates of a gyroscope, axis by axis.
class RateIntegral {
 public:
  RateIntegral(std::span<const InertialSample> samples, std::int64_t zero_ns) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      times_.push_back(static_cast<double>(samples[i].stamp_ns - zero_ns) / kNsPerSecond);
      if (i > 0) {
        sum += 0.5 * (times_[i] - times_[i - 1]) *
               (samples[i - 1].angular_rate + samples[i].angular_rate);
      }
      sums_.push_back(sum);
    }
  }

  bool Reaches(double from, double to) const {
    return from >= times_.front() && to <= times_.back();
  }
  Vector3d Mean(double from, double to) const { return (At(to) - At(from)) / (to - from); }

 private:
  Vector3d At(double time) const {
    const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
    const auto i = static_cast<std::size_t>(after - times_.begin());
    const double s = (time - times_[i - 1]) / (times_[i] - times_[i - 1]);
    return (1 - s) * sums_[i - 1] + s * sums_[i];
  }

  std::vector<double> times_;
  std::vector<Vector3d> sums_;
};

constexpr double kMostOffset = 0.3;  // seconds

std::vector<Turn> TurnsOf(const Trajectory& camera, std::int64_t zero_ns) {
  constexpr double kShortest = 0.04, kLongest = 0.15;
  std::vector<Turn> turns;
  std::size_t first = 0;
  for (std::size_t i = 1; i < camera.size(); ++i) {
    const double seconds =
        static_cast<double>(camera[i].stamp_ns - camera[first].stamp_ns) / kNsPerSecond;
    if (seconds < kShortest) continue;
    if (seconds <= kLongest) {
      const Eigen::Quaterniond turn = camera[first].world_from_camera.rotation.conjugate() *
                                      camera[i].world_from_camera.rotation;
      const double from = static_cast<double>(camera[first].stamp_ns - zero_ns) / kNsPerSecond;
      turns.push_back({from, from + seconds, LogSo3(turn) / seconds});
    }
    first = i;
  }
  return turns;
}

// The best rotation and bias at a time offset.
struct RateFit {
  Matrix3d rotation;
  Vector3d bias;
  double squared_error = 0, energy = 0;  // of the gyroscope about its mean
  Matrix3d spread;                       // of the camera's rates about their mean
};

RateFit FitAt(const std::vector<Turn>& turns, const RateIntegral& gyroscope, double offset) {
  const auto count = static_cast<double>(turns.size());
  std::vector<Vector3d> measured;
  Vector3d mean_measured = Vector3d::Zero(), mean_rate = Vector3d::Zero();
  for (const Turn& turn : turns) {
    measured.push_back(gyroscope.Mean(turn.from + offset, turn.to + offset));
    mean_measured += measured.back() / count;
    mean_rate += turn.rate / count;
  }
  RateFit fit;
  fit.spread.setZero();
  Matrix3d correlation = Matrix3d::Zero();
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Vector3d rate = turns[i].rate - mean_rate;
    correlation += (measured[i] - mean_measured) * rate.transpose();
    fit.energy += (measured[i] - mean_measured).squaredNorm();
    fit.spread += rate * rate.transpose();
  }
  fit.rotation = FitRotation(correlation).rotation;
  fit.bias = mean_measured - fit.rotation * mean_rate;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    fit.squared_error += (measured[i] - fit.rotation * turns[i].rate - fit.bias).squaredNorm();
  }
  return fit;
}

// The offset of the least error among `count` ones on both sides of the middle.
double BestOffset(const std::vector<Turn>& turns,
                  const RateIntegral& gyroscope,
                  double middle,
                  double step,
                  int count) {
  double best = middle, least = FitAt(turns, gyroscope, middle).squared_error;
  for (int i = -count; i <= count; ++i) {
    const double error = FitAt(turns, gyroscope, middle + i * step).squared_error;
    if (error >= least) continue;
    least = error;
    best = middle + i * step;
  }
  return best;
}

// The 16 numbers of a motion as in a camera file.
std::string RowsOf(const Rigid3& motion) {
  const Eigen::Matrix4d matrix = motion.Matrix();
  std::string rows;
  for (int i = 0; i < 16; ++i) {
    rows += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", matrix(i / 4, i % 4));
  }
  return rows;
}

}  // namespace

std::optional<RateAlignment> AlignRates(const Trajectory& camera,
                                        std::span<const InertialSample> samples) {
  constexpr std::size_t kFewest = 20;
  constexpr double kCoarse = 5e-3, kFine = 5e-4, kLeastShare = 0.5;
  constexpr double kMostOffsetSigma = 1e-3, kMostRotationSigma = 0.5 * kDegree;
  if (samples.size() < 3) return std::nullopt;
  const std::int64_t zero_ns = samples.front().stamp_ns;
  const RateIntegral gyroscope(samples, zero_ns);
  std::vector<Turn> turns = TurnsOf(camera, zero_ns);
  std::erase_if(turns, [&](const Turn& turn) {
    const double margin = kMostOffset + 2 * kCoarse;
    return !gyroscope.Reaches(turn.from - margin, turn.to + margin);
  });
  if (turns.size() < kFewest) return std::nullopt;
  const int steps = static_cast<int>(std::lround(kMostOffset / kCoarse));
  const double coarse = BestOffset(turns, gyroscope, 0, kCoarse, steps);
  if (std::abs(coarse) > kMostOffset - kCoarse / 2) return std::nullopt;
  const double fine = BestOffset(turns, gyroscope, coarse, kFine, 10);
  const double before = FitAt(turns, gyroscope, fine - kCoarse).squared_error;
  const double after = FitAt(turns, gyroscope, fine + kCoarse).squared_error;
  const double least = FitAt(turns, gyroscope, fine).squared_error;
  const double curvature = (before - 2 * least + after) / (kCoarse * kCoarse);
  if (!(curvature > 0)) return std::nullopt;

  RateAlignment result;
  const double correction = 0.5 * (before - after) / kCoarse / curvature;
  result.time_offset = fine + std::clamp(correction, -kFine, kFine);
  const RateFit fit = FitAt(turns, gyroscope, result.time_offset);
  constexpr double kUnknowns = 7;
  const double variance = fit.squared_error / (3 * static_cast<double>(turns.size()) - kUnknowns);
  const Matrix3d information = fit.spread.trace() * Matrix3d::Identity() - fit.spread;
  result.intervals = turns.size();
  result.rate_sigma = std::sqrt(variance);
  result.time_offset_sigma = std::sqrt(2 * variance / curvature);
  result.rotation_sigma = std::sqrt(variance / EigenvaluesOf<3>(information)(0));
  result.imu_from_camera = Eigen::Quaterniond(fit.rotation).normalized();
  result.gyroscope_bias = fit.bias;
  const bool known = fit.squared_error < kLeastShare * fit.energy &&
                     result.time_offset_sigma < kMostOffsetSigma &&
                     result.rotation_sigma < kMostRotationSigma;
  return known ? std::optional(result) : std::nullopt;
}

std::vector<std::string> AlignmentFaults(const RateAlignment& alignment,
                                         const InertialCalibration& calibration) {
  constexpr double kDeviations = 4, kLeastAngle = kDegree, kLeastOffset = 1e-3;
  std::vector<std::string> faults;
  if (calibration.imu_from_left) {
    const double angle =
        AngularDistance(calibration.imu_from_left->rotation, alignment.imu_from_camera);
    if (angle > std::max(kLeastAngle, kDeviations * alignment.rotation_sigma)) {
      const Rigid3 right{alignment.imu_from_camera, calibration.imu_from_left->translation};
      faults.push_back(fmt::format(
          "imu_from_left is turned by {:.1f} degrees against what camera and gyroscope measured; "
          "with the rotation measured it would be imu_from_left: [{}]",
          angle / kDegree,
          RowsOf(right)));
    }
  }
  const double of_file = calibration.time_offset.value_or(0);
  if (std::abs(alignment.time_offset - of_file) >
      std::max(kLeastOffset, kDeviations * alignment.time_offset_sigma)) {
    faults.push_back(
        fmt::format("time_offset is {:.4f} s, but {:.4f} s by what camera and gyroscope measured",
                    of_file,
                    alignment.time_offset));
  }
  return faults;
}

}  // namespace plumbline
