// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/inertial_check.h"

#include "plumbline/base/counted.h"
#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include <fmt/core.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;
using Samples = std::span<const InertialSample>;
using Channel3 = Vector3d InertialSample::*;

double SecondsOf(std::int64_t ns) { return static_cast<double>(ns) / kNsPerSecond; }

// The value that a share of the values is at most.
double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

void CheckTimes(Samples samples, InertialCheck& check) {
  check.samples = samples.size();
  if (samples.size() < 2) return;
  check.seconds = SecondsOf(samples.back().stamp_ns - samples.front().stamp_ns);
  const double median = MedianInterval(samples);
  check.rate_hz = 1 / median;
  std::vector<double> off;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double interval = SecondsOf(samples[i].stamp_ns - samples[i - 1].stamp_ns);
    check.longest_gap = std::max(check.longest_gap, interval);
    if (interval > 1.5 * median) {
      ++check.gaps;
    } else {
      off.push_back(std::abs(interval - median));
    }
  }
  check.jitter = Quantile(std::move(off), 0.95);
}

double LargestOf(Samples samples, Channel3 channel) {
  double largest = 0;
  for (const InertialSample& sample : samples) {
    largest = std::max(largest, (sample.*channel).cwiseAbs().maxCoeff());
  }
  return largest;
}

// Counts samples that reach the range; with none given, the largest value if it stands.
std::size_t SaturatedOf(Samples samples, Channel3 channel, double range, double largest) {
  const double limit = std::isfinite(range) ? range : largest;
  std::size_t count = 0, in_a_row = 0, longest = 0;
  for (const InertialSample& sample : samples) {
    const bool at = (sample.*channel).cwiseAbs().maxCoeff() >= limit;
    count += at ? 1 : 0;
    in_a_row = at ? in_a_row + 1 : 0;
    longest = std::max(longest, in_a_row);
  }
  return std::isfinite(range) || longest >= 3 ? count : 0;
}

Vector3d MeanOf(Samples samples, Channel3 channel) {
  Vector3d sum = Vector3d::Zero();
  for (const InertialSample& sample : samples) sum += sample.*channel;
  return sum / static_cast<double>(samples.size());
}

// Deviation of an axis from the mean.
double SpreadOf(Samples samples, Channel3 channel) {
  const Vector3d mean = MeanOf(samples, channel);
  double sum = 0;
  for (const InertialSample& sample : samples) sum += (sample.*channel - mean).squaredNorm();
  return std::sqrt(sum / (3 * static_cast<double>(samples.size())));
}

// Sum of squares of the white noise of all axes, by differences.
double NoiseOf(Samples samples, Channel3 channel) {
  double sum = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    sum += (samples[i].*channel - samples[i - 1].*channel).squaredNorm() / 2;
  }
  return sum / (3 * static_cast<double>(samples.size() - 1));
}

void CheckRest(Samples samples, InertialCheck& check) {
  constexpr double kRateSpread = 0.02, kForceSpread = 0.2, kMeanRate = 0.1;
  const auto second = static_cast<std::size_t>(std::lround(check.rate_hz));
  if (second < 10) return;
  double rates = 0, forces = 0;
  Vector3d bias = Vector3d::Zero();
  for (std::size_t i = 0; i + second <= samples.size(); i += second) {
    const Samples part = samples.subspan(i, second);
    const Vector3d mean = MeanOf(part, &InertialSample::angular_rate);
    if (mean.norm() > kMeanRate || SpreadOf(part, &InertialSample::angular_rate) > kRateSpread ||
        SpreadOf(part, &InertialSample::specific_force) > kForceSpread) {
      continue;
    }
    check.rest_seconds += 1;
    rates += NoiseOf(part, &InertialSample::angular_rate);
    forces += NoiseOf(part, &InertialSample::specific_force);
    bias += mean;
  }
  if (check.rest_seconds == 0) return;
  const double scale = 1 / (check.rest_seconds * check.rate_hz);
  check.gyroscope_noise_density = std::sqrt(rates * scale);
  check.accelerometer_noise_density = std::sqrt(forces * scale);
  check.gyroscope_bias = bias / check.rest_seconds;
}

// Mean squared angle between the direction of the force and the former one turned by the rates
// times `unit`, over steps of half a second.
double TurnError(Samples samples, std::size_t step, double unit) {
  const std::size_t window = std::max<std::size_t>(step / 3, 1);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + step + window <= samples.size(); i += step) {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    for (std::size_t k = i; k < i + step; ++k) {
      // Windows begin at i and i + step, and turn alike within.
      const double dt = SecondsOf(samples[k + 1].stamp_ns - samples[k].stamp_ns);
      turn = turn * ExpSo3(unit * dt * samples[k].angular_rate);
    }
    const Vector3d before = MeanOf(samples.subspan(i, window), &InertialSample::specific_force);
    const Vector3d after =
        MeanOf(samples.subspan(i + step, window), &InertialSample::specific_force);
    const Vector3d expected = turn.normalized().conjugate() * before;
    const Eigen::Quaterniond off = ShortestTurn(expected, after);
    sum += LogSo3(off).squaredNorm();
    ++count;
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

void CheckUnits(Samples samples, InertialCheck& check) {
  std::vector<double> forces;
  for (const InertialSample& sample : samples) forces.push_back(sample.specific_force.norm());
  check.median_force = Quantile(forces, 0.5);
  const double spread = Quantile(forces, 0.75) - Quantile(forces, 0.25);
  const double median = check.median_force;
  check.forces_in_g = median > 0.7 && median < 1.3 && spread < 0.3 * median;
  check.gravity_taken_off = !check.forces_in_g && median < 5;
  if (check.gravity_taken_off) return;  // the force has no direction to compare rates with
  constexpr double kLeast = 0.05;       // rad, below which rates tell nothing
  const auto step = std::max<std::size_t>(static_cast<std::size_t>(check.rate_hz / 2), 1);
  const double radians = TurnError(samples, step, 1);
  const double degrees = TurnError(samples, step, kDegree);
  // A drone banks, so that its force has one direction in the sensor whatever the rates; but it
  // does not turn so fast.
  constexpr double kFastest = 8;  // rad/s
  check.rates_in_degrees =
      check.largest_rate > kFastest && radians > kLeast * kLeast && degrees < radians / 4;
}

void AddNoiseFault(const char* key, double measured, double of_file, std::vector<std::string>& to) {
  constexpr double kFactor = 3;
  if (measured < kFactor * of_file && measured > of_file / kFactor) return;
  to.push_back(fmt::format(
      "{} is {:.3g}, but {:.3g} by the samples at rest: noise is believed {:.2g} times as {}",
      key,
      of_file,
      measured,
      std::max(measured / of_file, of_file / measured),
      measured > of_file ? "small" : "large"));
}

void AddUnitFaults(const InertialCheck& check, std::vector<std::string>& faults) {
  if (check.forces_in_g) {
    faults.push_back(
        fmt::format("forces have a median of {:.3g}: they seem to be in g, expected m/s^2",
                    check.median_force));
  }
  if (check.gravity_taken_off) {
    faults.push_back(fmt::format(
        "forces have a median of {:.3g} m/s^2: gravity seems to be taken off, expected with it",
        check.median_force));
  }
  if (check.rates_in_degrees) {
    faults.emplace_back(
        "rates turn the direction of gravity as degrees per second would: expected rad/s");
  }
}

}  // namespace

InertialCheck CheckInertial(const OrderedSamples& ordered, const InertialCalibration& calibration) {
  const Samples samples = ordered.samples;
  InertialCheck check;
  check.backward = ordered.backward;
  check.repeated = ordered.repeated;
  check.ahead = ordered.ahead;
  CheckTimes(samples, check);
  if (samples.size() < 2) return check;
  check.largest_rate = LargestOf(samples, &InertialSample::angular_rate);
  check.largest_force = LargestOf(samples, &InertialSample::specific_force);
  check.saturated_rates = SaturatedOf(
      samples, &InertialSample::angular_rate, calibration.range.gyroscope, check.largest_rate);
  check.saturated_forces = SaturatedOf(samples,
                                       &InertialSample::specific_force,
                                       calibration.range.accelerometer,
                                       check.largest_force);
  CheckRest(samples, check);
  CheckUnits(samples, check);
  return check;
}

std::vector<std::string> InertialFaults(const InertialCheck& check,
                                        const InertialCalibration& calibration) {
  std::vector<std::string> faults;
  const auto add_count = [&](std::size_t count, const char* noun, const std::string& what) {
    if (count > 0) faults.push_back(Counted(count, noun) + ' ' + what);
  };
  add_count(check.gaps,
            "gap",
            fmt::format("above 1.5 intervals, the longest {:.3f} s", check.longest_gap));
  add_count(check.backward, "sample", "left out, with a stamp before that of a former one");
  add_count(check.repeated, "sample", "left out, with the stamp of the former one");
  add_count(check.ahead, "sample", "left out, with a stamp far ahead of those around it");
  add_count(check.saturated_rates,
            "sample",
            fmt::format("at the gyroscope's range; the largest rate is {:.4g} rad/s",
                        check.largest_rate));
  add_count(check.saturated_forces,
            "sample",
            fmt::format("at the accelerometer's range; the largest force is {:.4g} m/s^2",
                        check.largest_force));
  AddUnitFaults(check, faults);
  const bool strange = check.forces_in_g || check.gravity_taken_off || check.rates_in_degrees;
  if (calibration.noise && check.rest_seconds > 0 && !strange) {
    AddNoiseFault("gyroscope_noise_density",
                  check.gyroscope_noise_density,
                  calibration.noise->gyroscope_noise_density,
                  faults);
    AddNoiseFault("accelerometer_noise_density",
                  check.accelerometer_noise_density,
                  calibration.noise->accelerometer_noise_density,
                  faults);
  }
  if (calibration.rate_hz && check.rate_hz > 0 &&
      std::abs(check.rate_hz / *calibration.rate_hz - 1) > 0.05) {
    faults.push_back(fmt::format(
        "rate_hz is {:.4g}, but {:.4g} by the stamps", *calibration.rate_hz, check.rate_hz));
  }
  return faults;
}

}  // namespace plumbline
