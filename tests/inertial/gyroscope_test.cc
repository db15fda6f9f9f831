// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/gyroscope.h"

#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"

#include "tests/inertial/invented_motion.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const Eigen::Quaterniond kPlaceOfImu = ExpSo3({0.4, -1.2, 0.7});  // imu_from_left
const Eigen::Vector3d kSensorBias(0.05, -0.04, 0.08);
constexpr int kFrames = 240;  // at 20 Hz

std::int64_t StampOf(int frame) { return kMotionStart + frame * (kNsPerSecond / 20); }

// A camera at 20 Hz with true rotations, and samples at 200 Hz with bias and noise, whose clock is
// ahead by `offset` seconds.
struct Turning {
  std::vector<Eigen::Quaterniond> cam_from_world;
  std::vector<InertialSample> samples;
};
Turning Turn(double offset = 0) {
  Rng rng(1);
  Turning turning;
  Eigen::Quaterniond imu = Eigen::Quaterniond::Identity();  // world_from_imu
  constexpr double kStep = 1e-3;
  for (int i = 0; i <= 50 * kFrames; ++i) {
    const double t = i * kStep;
    if (i % 50 == 0) turning.cam_from_world.push_back((imu * kPlaceOfImu).conjugate());
    if (i % 5 == 0) {
      InertialSample sample = IdealSample(t);
      sample.stamp_ns += std::llround(offset * kNsPerSecond);
      sample.angular_rate += kSensorBias + RandomVector<3>(rng, 2.4e-3);
      turning.samples.push_back(sample);
    }
    imu = (imu * ExpSo3(kStep * IdealSample(t + kStep / 2).angular_rate)).normalized();
  }
  return turning;
}

InertialCalibration CalibrationAt(const Eigen::Quaterniond& imu_from_left) {
  InertialCalibration calibration;
  calibration.imu_from_left = {imu_from_left, {0.1, 0, 0}};
  calibration.time_offset = 0;
  return calibration;
}

Eigen::Quaterniond TrueTurn(const Turning& turning, int from, int to) {
  return turning.cam_from_world[static_cast<std::size_t>(to)] *
         turning.cam_from_world[static_cast<std::size_t>(from)].conjugate();
}

// Lets the gyroscope see all frames, each turn measured by the camera to 0.5 mrad.
void ShowAll(const Turning& turning, Gyroscope& gyroscope) {
  Rng rng(2);
  constexpr double kSigma = 5e-4;
  const Eigen::Matrix3d covariance = kSigma * kSigma * Eigen::Matrix3d::Identity();
  for (int k = 1; k < kFrames; ++k) {
    const auto turn = gyroscope.Turn(StampOf(k - 1), StampOf(k));
    if (!turn) continue;
    const Eigen::Quaterniond measured =
        ExpSo3(RandomVector<3>(rng, kSigma)) * TrueTurn(turning, k - 1, k);
    gyroscope.Observe(*turn, measured, covariance, 0.05);
  }
}

TEST(Gyroscope, TellsTheTurnWithinItsDeviationBeforeTheBiasIsKnown) {
  const Turning turning = Turn();
  Gyroscope gyroscope(CalibrationAt(kPlaceOfImu), Eigen::Quaterniond::Identity());
  gyroscope.Add(turning.samples);
  for (const int frames : {1, 2, 10}) {
    const auto turn = gyroscope.Turn(StampOf(20), StampOf(20 + frames));
    ASSERT_TRUE(turn);
    const Eigen::Vector3d error =
        LogSo3(TrueTurn(turning, 20, 20 + frames) * turn->b_from_a.conjugate());
    EXPECT_LT(error.dot(turn->covariance.inverse() * error), 12) << frames;
    EXPECT_GT(error.norm(), 0.5 * frames * 0.05 * kSensorBias.norm());  // it is not known yet
  }
}

TEST(Gyroscope, LearnsBiasPlaceAndClock) {
  const Eigen::Vector3d off(0.03, -0.02, 0.01);
  const Turning turning = Turn(0.002);
  Gyroscope gyroscope(CalibrationAt(kPlaceOfImu * ExpSo3(off)), Eigen::Quaterniond::Identity());
  gyroscope.Add(turning.samples);
  ShowAll(turning, gyroscope);
  EXPECT_TRUE(gyroscope.agrees());
  EXPECT_EQ(gyroscope.contradicted(), 0);
  const GyroscopeErrors& errors = gyroscope.errors();
  EXPECT_LT((errors.head<3>() - kSensorBias).norm(), 2e-3);
  EXPECT_LT((errors.segment<3>(3) - off).norm(), 3e-3);
  EXPECT_NEAR(errors[6], 0.002, 5e-4);
  const auto turn = gyroscope.Turn(StampOf(100), StampOf(110));
  ASSERT_TRUE(turn);
  EXPECT_LT(LogSo3(TrueTurn(turning, 100, 110) * turn->b_from_a.conjugate()).norm(), 3e-3);
}

TEST(Gyroscope, IsOfTheRectifiedCamera) {
  const Turning turning = Turn();
  const Eigen::Quaterniond rectified_from_left = ExpSo3({0.02, 0.05, -0.01});
  Gyroscope of_left(CalibrationAt(kPlaceOfImu), Eigen::Quaterniond::Identity());
  Gyroscope of_rectified(CalibrationAt(kPlaceOfImu), rectified_from_left);
  of_left.Add(turning.samples);
  of_rectified.Add(turning.samples);
  const auto left = of_left.Turn(StampOf(3), StampOf(9));
  const auto rectified = of_rectified.Turn(StampOf(3), StampOf(9));
  ASSERT_TRUE(left && rectified);
  const Eigen::Quaterniond expected =
      rectified_from_left * left->b_from_a * rectified_from_left.conjugate();
  EXPECT_LT(LogSo3(expected * rectified->b_from_a.conjugate()).norm(), 1e-9);
}

TEST(Gyroscope, DerivativesAreThoseOfTheErrors) {
  const Turning turning = Turn();
  const auto turn_with = [&](const GyroscopeErrors& errors) {
    // Errors move only by observations: the same ones in the calibration and the samples.
    InertialCalibration calibration = CalibrationAt(kPlaceOfImu * ExpSo3(-errors.segment<3>(3)));
    calibration.time_offset = errors[6];
    Gyroscope gyroscope(calibration, Eigen::Quaterniond::Identity());
    std::vector<InertialSample> samples = turning.samples;
    for (InertialSample& sample : samples) sample.angular_rate -= errors.head<3>();
    gyroscope.Add(samples);
    return *gyroscope.Turn(StampOf(7), StampOf(10));
  };
  const CameraTurn turn = turn_with(GyroscopeErrors::Zero());
  for (int i = 0; i < 7; ++i) {
    const double step = i == 6 ? 1e-3 : 1e-4;
    GyroscopeErrors up = GyroscopeErrors::Zero(), down = GyroscopeErrors::Zero();
    up[i] = step;
    down[i] = -step;
    const Eigen::Vector3d numeric =
        LogSo3(turn_with(up).b_from_a * turn_with(down).b_from_a.conjugate()) / (2 * step);
    EXPECT_LT((numeric - turn.by_errors.col(i)).norm(), i == 6 ? 0.06 : 1e-4) << i;
  }
}

TEST(Gyroscope, IsPutAsideWhereTheCameraContradicts) {
  const Turning turning = Turn();
  const Eigen::Quaterniond turned = kPlaceOfImu * ExpSo3({0, 0, 0.5 * M_PI});
  Gyroscope gyroscope(CalibrationAt(turned), Eigen::Quaterniond::Identity());
  gyroscope.Add(turning.samples);
  ShowAll(turning, gyroscope);
  EXPECT_FALSE(gyroscope.agrees());
  EXPECT_GT(gyroscope.contradicted(), kFrames / 2);
}

// A pose that a prediction took part in tells as much as the measurement that it contains.
TEST(Gyroscope, LearnsTheSameFromAPoseThatItPredicted) {
  const Turning turning = Turn();
  Gyroscope apart(CalibrationAt(kPlaceOfImu), Eigen::Quaterniond::Identity());
  Gyroscope within = apart;
  apart.Add(turning.samples);
  within.Add(turning.samples);
  const Eigen::Matrix3d measured = 1e-4 * Eigen::Matrix3d::Identity();
  const CameraTurn turn = *apart.Turn(StampOf(1), StampOf(2));
  const Eigen::Vector3d residual(0.004, -0.003, 0.002);
  apart.Observe(turn, ExpSo3(residual) * turn.b_from_a, measured, 0.05);
  const Eigen::Matrix3d gain = turn.covariance * (turn.covariance + measured).inverse();
  const Eigen::Matrix3d estimated =
      turn.covariance - gain * turn.covariance - 1e-6 * Eigen::Matrix3d::Identity();
  within.ObserveChange(turn, turn.covariance, gain * residual, estimated, 0.05);
  EXPECT_LT((apart.errors() - within.errors()).norm(), 1e-3 * apart.errors().norm());
  EXPECT_LT((apart.covariance() - within.covariance()).norm(), 1e-3 * apart.covariance().norm());
}

TEST(Gyroscope, TellsNothingWhereSamplesAreMissingOrClipped) {
  const Turning turning = Turn();
  const auto told = [&](const auto& change) {
    std::vector<InertialSample> samples = turning.samples;
    change(samples);
    Gyroscope gyroscope(CalibrationAt(kPlaceOfImu), Eigen::Quaterniond::Identity());
    gyroscope.Add(samples);
    const auto turn = gyroscope.Turn(StampOf(5), StampOf(11));  // samples 50 to 110
    return turn ? std::optional(turn->covariance.trace()) : std::nullopt;
  };
  const auto whole = told([](auto&) {});
  ASSERT_TRUE(whole);
  EXPECT_FALSE(told([](auto& s) { s.erase(s.begin() + 60, s.begin() + 100); }));
  EXPECT_FALSE(told([](auto& s) { s.erase(s.begin(), s.begin() + 51); }));
  EXPECT_FALSE(told([](auto& s) { s.resize(100); }));
  EXPECT_FALSE(told([](auto& s) {
    for (int i = 70; i < 74; ++i) s[static_cast<std::size_t>(i)].angular_rate.x() = 4.3;
  }));
  EXPECT_TRUE(told([](auto& s) { s.resize(109); }));  // the newest is 10 ms late
  const auto with_gap = told([](auto& s) { s.erase(s.begin() + 60, s.begin() + 80); });
  ASSERT_TRUE(with_gap);
  EXPECT_GT(*with_gap, *whole + 1e-4);
}

TEST(Gyroscope, KeepsTheNewestSamplesInOrder) {
  Gyroscope gyroscope(CalibrationAt(kPlaceOfImu), Eigen::Quaterniond::Identity());
  const auto sample = [](double t) { return IdealSample(t); };
  for (int i = 0; i < 10000; ++i) gyroscope.Add(std::vector{sample(0.01 * i), sample(0.01 * i)});
  gyroscope.Add(std::vector{sample(3)});  // goes back
  EXPECT_FALSE(gyroscope.Turn(StampOf(20), StampOf(21)));
  EXPECT_TRUE(gyroscope.Turn(kMotionStart + 90 * kNsPerSecond, kMotionStart + 91 * kNsPerSecond));
}

}  // namespace
}  // namespace plumbline
