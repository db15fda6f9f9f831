// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/inertial_check.h"

#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;
using Samples = std::vector<InertialSample>;

// A sensor of EuRoC's noise that lies still for 3 s and then is tilted and turned for 7 s.
Samples HandHeld(double rate_hz = 200) {
  const InertialNoise noise;
  Rng rng(1);
  Samples samples;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  // world_from_imu
  const double white = std::sqrt(rate_hz);
  for (int i = 0; i < static_cast<int>(10 * rate_hz); ++i) {
    const double t = i / rate_hz;
    Vector3d rate = Vector3d::Zero(), push = Vector3d::Zero();
    if (t > 3) {
      rate = {0.5 * std::sin(2 * t), 0.4 * std::cos(1.5 * t), 0.3};
      push = {std::sin(4 * t), std::cos(5 * t), std::sin(3 * t)};
    }
    samples.push_back({std::llround(t * kNsPerSecond),
                       rate + Vector3d(0.01, 0, -0.02) +
                           RandomVector<3>(rng, white * noise.gyroscope_noise_density),
                       turn.conjugate() * (Vector3d(0, 0, 9.81) + push) +
                           RandomVector<3>(rng, white * noise.accelerometer_noise_density)});
    turn = turn * ExpSo3(rate / rate_hz);
  }
  return samples;
}

InertialCalibration Euroc() {
  InertialCalibration calibration;
  calibration.noise = InertialNoise{};
  calibration.rate_hz = 200;
  return calibration;
}

std::vector<std::string> FaultsOf(const Samples& samples,
                                  const InertialCalibration& calibration = Euroc()) {
  return InertialFaults(CheckInertial(InOrderOfTime(samples), calibration), calibration);
}

// The only fault; fails if there are others.
std::string OnlyFaultOf(const Samples& samples, const InertialCalibration& calibration = Euroc()) {
  const std::vector<std::string> faults = FaultsOf(samples, calibration);
  EXPECT_EQ(faults.size(), 1U);
  return faults.empty() ? "" : faults.front();
}

TEST(CheckInertial, MeasuresRateRestNoiseAndBias) {
  const InertialCheck check = CheckInertial(InOrderOfTime(HandHeld()), {});
  EXPECT_EQ(check.samples, 2000U);
  EXPECT_NEAR(check.rate_hz, 200, 1e-6);
  EXPECT_NEAR(check.seconds, 9.995, 1e-9);
  EXPECT_LT(check.jitter, 1e-6);
  EXPECT_EQ(check.rest_seconds, 3);
  const InertialNoise noise;
  EXPECT_NEAR(check.gyroscope_noise_density / noise.gyroscope_noise_density, 1, 0.06);
  EXPECT_NEAR(check.accelerometer_noise_density / noise.accelerometer_noise_density, 1, 0.06);
  EXPECT_LT((check.gyroscope_bias - Vector3d(0.01, 0, -0.02)).norm(), 5e-4);
  EXPECT_NEAR(check.median_force, 9.8, 0.3);
  EXPECT_TRUE(FaultsOf(HandHeld()).empty());
}

TEST(CheckInertial, TellsJitterGapsAndStamps) {
  Samples late = HandHeld();
  Rng rng(2);
  for (InertialSample& sample : late) sample.stamp_ns += std::llround(rng.Uniform(-1e6, 1e6));
  const InertialCheck check = CheckInertial(InOrderOfTime(late), {});
  EXPECT_NEAR(check.jitter, 1.5e-3, 0.4e-3);

  Samples gap = HandHeld();
  gap.erase(gap.begin() + 900, gap.begin() + 1000);
  gap.erase(gap.begin() + 1500);
  EXPECT_EQ(OnlyFaultOf(gap), "2 gaps above 1.5 intervals, the longest 0.505 s");
  Samples back = HandHeld();
  back.insert(back.begin() + 500, back[400]);
  back.insert(back.begin() + 700, back[699]);
  const std::vector<std::string> faults = FaultsOf(back);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0], "1 sample left out, with a stamp before that of a former one");
  EXPECT_EQ(faults[1], "1 sample left out, with the stamp of the former one");
}

TEST(CheckInertial, TellsSaturation) {
  Samples clipped = HandHeld();
  for (InertialSample& sample : clipped) {
    sample.angular_rate = sample.angular_rate.cwiseMax(-0.4).cwiseMin(0.4);
  }
  EXPECT_NE(OnlyFaultOf(clipped).find("samples at the gyroscope's range; the largest rate is 0.4"),
            std::string::npos);
  InertialCalibration narrow = Euroc();
  narrow.range.accelerometer = 10;
  EXPECT_NE(OnlyFaultOf(HandHeld(), narrow).find("samples at the accelerometer's range"),
            std::string::npos);
}

TEST(CheckInertial, TellsUnitsThatCannotBe) {
  Samples degrees = HandHeld(), in_g = HandHeld(), without = HandHeld();
  for (InertialSample& sample : degrees) sample.angular_rate /= kDegree;
  EXPECT_EQ(OnlyFaultOf(degrees),
            "rates turn the direction of gravity as degrees per second would: expected rad/s");
  for (InertialSample& sample : in_g) sample.specific_force /= 9.81;
  EXPECT_NE(OnlyFaultOf(in_g).find("in g, expected m/s^2"), std::string::npos);
  for (std::size_t i = 0; i < without.size(); ++i) {
    const double t = static_cast<double>(i) / 200;
    without[i].specific_force = {std::sin(4 * t), std::cos(5 * t), std::sin(3 * t)};
  }
  EXPECT_NE(OnlyFaultOf(without).find("gravity seems to be taken off"), std::string::npos);
}

TEST(CheckInertial, ComparesNoiseAndRateWithTheFile) {
  InertialCalibration wrong = Euroc();
  wrong.noise->gyroscope_noise_density *= 10;
  EXPECT_NE(OnlyFaultOf(HandHeld(), wrong).find("gyroscope_noise_density is 0.0017, but 0.0001"),
            std::string::npos);
  wrong = Euroc();
  wrong.noise->accelerometer_noise_density /= 10;
  EXPECT_NE(OnlyFaultOf(HandHeld(), wrong).find("times as small"), std::string::npos);
  wrong = Euroc();
  wrong.rate_hz = 100;
  EXPECT_EQ(OnlyFaultOf(HandHeld(), wrong), "rate_hz is 100, but 200 by the stamps");
}

TEST(CheckInertial, SaysNothingOfAlmostNothing) {
  for (const std::size_t count : {0U, 1U, 2U, 5U}) {
    const Samples all = HandHeld(), few(all.begin(), all.begin() + static_cast<int>(count));
    const InertialCheck check = CheckInertial(InOrderOfTime(few), Euroc());
    EXPECT_EQ(check.samples, count);
    EXPECT_TRUE(FaultsOf(few).empty()) << count;
  }
}

}  // namespace
}  // namespace plumbline
