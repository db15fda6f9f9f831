// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/preintegration.h"

#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"

#include "tests/inertial/invented_motion.h"
#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;
using Samples = std::vector<InertialSample>;

constexpr std::int64_t kFrom = kMotionStart + 1'234'567;  // between samples
constexpr std::int64_t kTo = kFrom + kNsPerSecond;
const InertialBias kBias{{0.02, -0.01, 0.03}, {0.1, 0.2, -0.15}};

Preintegral Between(const Samples& samples,
                    std::int64_t from = kFrom,
                    std::int64_t to = kTo,
                    const InertialBias& bias = {},
                    const InertialNoise& noise = {},
                    const InertialRange& range = {}) {
  const auto result = Preintegrate(samples, from, to, bias, noise, range);
  EXPECT_TRUE(result.has_value());
  return result.value_or(Preintegral{});
}

// The tangent from one preintegral to another one.
Vector9d Apart(const Preintegral& a, const Preintegral& b) {
  Vector9d tangent;
  tangent << LogSo3(a.rotation.conjugate() * b.rotation), b.velocity - a.velocity,
      b.position - a.position;
  return tangent;
}

// Plain integration by the midpoints of steps of 0.1 ms.
Preintegral At10Kilohertz(double from, double seconds) {
  Preintegral sum;
  const double dt = 1e-4;
  for (int i = 0; i < static_cast<int>(std::lround(seconds / dt)); ++i) {
    const InertialSample middle = IdealSample(from + (i + 0.5) * dt);
    const Vector3d force =
        sum.rotation * ExpSo3(0.5 * dt * middle.angular_rate) * middle.specific_force;
    sum.position += dt * sum.velocity + 0.5 * dt * dt * force;
    sum.velocity += dt * force;
    sum.rotation = (sum.rotation * ExpSo3(dt * middle.angular_rate)).normalized();
  }
  return sum;
}

TEST(Preintegrate, AgreesWithIntegrationAt10Kilohertz) {
  const double from = static_cast<double>(kFrom - kMotionStart) / kNsPerSecond;
  for (const double rate : {100.0, 200.0, 1000.0}) {
    const Vector9d error = Apart(At10Kilohertz(from, 1), Between(IdealSamples(rate)));
    EXPECT_LT(error.head<3>().norm(), 1e-4) << rate;
    EXPECT_LT(error.segment<3>(3).norm(), 1e-3) << rate;
    EXPECT_LT(error.tail<3>().norm(), 1e-3) << rate;
  }
  EXPECT_NEAR(Between(IdealSamples(200)).duration, 1, 1e-12);
}

TEST(Preintegrate, ErrorIsOfSecondOrderInTheInterval) {
  const double from = static_cast<double>(kFrom - kMotionStart) / kNsPerSecond;
  const Preintegral truth = At10Kilohertz(from, 1);
  const double coarse = Apart(truth, Between(IdealSamples(50))).norm();
  const double fine = Apart(truth, Between(IdealSamples(200))).norm();
  EXPECT_GT(coarse, 10 * fine);
}

TEST(Preintegrate, TwoPartsMakeTheWhole) {
  const Samples samples = IdealSamples(200);
  const std::int64_t middle = kFrom + 412'345'678;
  const Preintegral whole = Between(samples), first = Between(samples, kFrom, middle);
  const Preintegral second = Between(samples, middle, kTo);
  EXPECT_LT(AngularDistance(first.rotation * second.rotation, whole.rotation), 1e-6);
  EXPECT_LT((first.velocity + first.rotation * second.velocity - whole.velocity).norm(), 1e-4);
  EXPECT_LT((first.position + second.duration * first.velocity + first.rotation * second.position -
             whole.position)
                .norm(),
            1e-4);
}

TEST(Preintegrate, DerivativesByBiasAreThoseOfCentralDifferences) {
  const Samples samples = IdealSamples(200);
  const Preintegral at = Between(samples, kFrom, kTo, kBias);
  const auto moved = [&](const Vector6d& change) {
    const InertialBias bias{kBias.gyroscope + change.head<3>(),
                            kBias.accelerometer + change.tail<3>()};
    return Apart(at, Between(samples, kFrom, kTo, bias));
  };
  const auto numeric = NumericJacobian(moved, Vector6d(Vector6d::Zero()), 1e-3);
  EXPECT_LT((at.by_bias - numeric).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Preintegrate, DerivativeByTimeOffsetIsThatOfCentralDifferences) {
  const Samples samples = IdealSamples(1000);
  const Preintegral at = Between(samples, kFrom, kTo, kBias);
  const std::int64_t shift = 10'000'000;
  const Preintegral later = Between(samples, kFrom + shift, kTo + shift, kBias);
  const Preintegral earlier = Between(samples, kFrom - shift, kTo - shift, kBias);
  const Vector9d numeric = (Apart(at, later) - Apart(at, earlier)) / 0.02;
  EXPECT_GT(numeric.norm(), 1);
  EXPECT_LT((at.by_time_offset - numeric).norm(), 2e-3 * numeric.norm());
}

TEST(WithBias, IsOfFirstOrder) {
  const Samples samples = IdealSamples(200);
  const Preintegral zero = Between(samples);
  for (const double size : {1.0, 0.5}) {
    const InertialBias bias{0.01 / kBias.gyroscope.norm() * size * kBias.gyroscope,
                            size * kBias.accelerometer};
    const Vector9d error = Apart(Between(samples, kFrom, kTo, bias), WithBias(zero, bias));
    EXPECT_LT(error.head<3>().norm(), 1e-4 * size * size);
    EXPECT_LT(error.segment<3>(3).norm(), 2e-3 * size * size);
    EXPECT_LT(error.tail<3>().norm(), 1e-3 * size * size);
  }
}

// A sensor with white noise of each sample and biases that walk from kBias.
struct Draw {
  Samples samples;
  InertialBias first, last;
};
Draw Noisy(const Samples& ideal, double rate_hz, const InertialNoise& noise, std::uint64_t seed) {
  Rng rng(seed, "nees");
  Draw draw;
  InertialBias bias = kBias;
  draw.first = kBias;
  const double white = std::sqrt(rate_hz), walk = 1 / std::sqrt(rate_hz);
  for (InertialSample sample : ideal) {
    sample.angular_rate +=
        bias.gyroscope + RandomVector<3>(rng, white * noise.gyroscope_noise_density);
    sample.specific_force +=
        bias.accelerometer + RandomVector<3>(rng, white * noise.accelerometer_noise_density);
    draw.samples.push_back(sample);
    draw.last = bias;
    bias.gyroscope += RandomVector<3>(rng, walk * noise.gyroscope_random_walk);
    bias.accelerometer += RandomVector<3>(rng, walk * noise.accelerometer_random_walk);
  }
  return draw;
}

// Mean of e^T C^-1 e over 1,000 draws: 15, and by its own deviation 95 % of the time within 0.34.
double MeanNees(const InertialNoise& noise, const InertialNoise& believed) {
  const double rate = 200;
  Samples ideal;
  for (int i = 0; i <= 200; ++i) ideal.push_back(IdealSample(i / rate));
  const std::int64_t from = ideal.front().stamp_ns, to = ideal.back().stamp_ns;
  const Preintegral truth = Between(ideal, from, to);
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Draw draw = Noisy(ideal, rate, noise, seed);
    const Preintegral measured = Between(draw.samples, from, to, draw.first, believed);
    Eigen::Matrix<double, 15, 1> error;
    error << Apart(measured, truth), draw.last.gyroscope - draw.first.gyroscope,
        draw.last.accelerometer - draw.first.accelerometer;
    sum += error.dot(measured.covariance.ldlt().solve(error));
  }
  return sum / 1000;
}

TEST(Preintegrate, CovarianceIsThatOf1000Draws) {
  const double band = 1.96 * std::sqrt(2 * 15 / 1000.0);
  EXPECT_NEAR(MeanNees({}, {}), 15, band);
  InertialNoise walking;  // biases that walk dominate
  walking.gyroscope_random_walk = 2e-3;
  walking.accelerometer_random_walk = 3e-2;
  EXPECT_NEAR(MeanNees(walking, walking), 15, band);
}

TEST(Preintegrate, CovarianceTellsWrongNoiseApart) {
  InertialNoise noisier;
  noisier.gyroscope_noise_density *= 1.2;
  EXPECT_GT(MeanNees(noisier, {}), 15 + 3 * std::sqrt(2 * 15 / 1000.0));
}

TEST(Preintegrate, NoiseGrowsOverAGapAndWhereTheRangeIsReached) {
  const Samples samples = IdealSamples(200);
  const auto sigma = [](const Preintegral& p) { return std::sqrt(p.covariance(0, 0)); };
  const double whole = sigma(Between(samples));
  Samples gap = samples;
  gap.erase(gap.begin() + 60, gap.begin() + 160);
  // Half a second at 100 times the variance, and half a second as it is.
  EXPECT_NEAR(sigma(Between(gap)) / whole, std::sqrt(0.5 * 101 + 0.5), 0.3);
  InertialRange range;
  range.gyroscope = 0.69;
  EXPECT_GT(sigma(Between(samples, kFrom, kTo, {}, {}, range)), 10 * whole);
  range.gyroscope = 2;
  EXPECT_EQ(sigma(Between(samples, kFrom, kTo, {}, {}, range)), whole);
}

TEST(Preintegrate, NeedsSamplesAroundBothStamps) {
  const Samples samples = IdealSamples(200);
  const std::int64_t first = samples.front().stamp_ns, last = samples.back().stamp_ns;
  EXPECT_TRUE(Preintegrate(samples, first, last, {}, {}));
  EXPECT_FALSE(Preintegrate(samples, first - 1, last, {}, {}));
  EXPECT_FALSE(Preintegrate(samples, first, last + 1, {}, {}));
  EXPECT_FALSE(Preintegrate(samples, kTo, kFrom, {}, {}));
  EXPECT_FALSE(Preintegrate(samples, kFrom, kFrom, {}, {}));
  EXPECT_FALSE(Preintegrate({}, kFrom, kTo, {}, {}));
}

}  // namespace
}  // namespace plumbline
