// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/imu.h"

#include "worlds/path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

// Turning about the vertical at 0.7 rad/s on a circle of 2 m.
Rigid3 OnCircle(double time) {
  const double angle = 0.7 * time;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitZ())),
          {2 * std::cos(angle), 2 * std::sin(angle), 1}};
}

TEST(RecordImu, FeelsTurnCentripetalForceAndGravity) {
  const ImuRecording recording = RecordImu(OnCircle, 2, {}, 0, 1);
  ASSERT_EQ(recording.ideal.size(), 401U);
  for (const ImuSample& sample : recording.noisy) {
    EXPECT_LT((sample.angular_rate - Vector3d(0, 0, 0.7)).norm(), 1e-6);
    EXPECT_LT((sample.specific_force - Vector3d(-2 * 0.49, 0, 9.81)).norm(), 1e-5);
  }
}

TEST(RecordImu, IntegratesToTheWay) {
  // Dead reckoning with the ideal samples comes back to the path.
  const CameraPath path =
      WithCarrier(SplinePath({{{0, 0, 1}, 0, 0, 0, 0}, {{3, 1, 1.2}, 1, 0.1, 0, 0}}, {1, 1}),
                  Carrier::kHand,
                  3);
  ImuModel model;
  model.rate_hz = 1000;
  const ImuRecording recording = RecordImu(path.world_from_camera, path.duration, model, 0, 1);
  const double step = 1 / model.rate_hz;
  Rigid3 pose = path.world_from_camera(0);
  Vector3d velocity =
      (path.world_from_camera(1e-4).translation - path.world_from_camera(-1e-4).translation) / 2e-4;
  for (std::size_t i = 0; i + 1 < recording.ideal.size(); ++i) {
    const ImuSample &a = recording.ideal[i], &b = recording.ideal[i + 1];
    const Vector3d turn = 0.5 * step * (a.angular_rate + b.angular_rate);
    const Vector3d force = 0.5 * (a.specific_force + b.specific_force);
    const Vector3d acceleration = pose.rotation * ExpSo3(0.5 * turn) * force - Vector3d(0, 0, 9.81);
    pose.translation += step * velocity + 0.5 * step * step * acceleration;
    velocity += step * acceleration;
    pose.rotation = (pose.rotation * ExpSo3(turn)).normalized();
  }
  const Rigid3 end = path.world_from_camera(recording.ideal.back().time);
  EXPECT_LT((pose.translation - end.translation).norm(), 2e-3);
  EXPECT_LT(AngularDistance(pose.rotation, end.rotation), 1e-4);
}

TEST(RecordImu, NoiseHasItsDensityAndBiasesWalk) {
  const auto still = [](double) { return Rigid3{}; };
  const ImuModel model;
  const ImuRecording recording = RecordImu(still, 100, model, 1, 1);
  double white = 0, walk = 0;
  for (std::size_t i = 1; i < recording.noisy.size(); ++i) {
    const ImuSample &noisy = recording.noisy[i], &bias = recording.biases[i];
    white += (noisy.angular_rate - bias.angular_rate).squaredNorm();
    walk += (bias.angular_rate - recording.biases[i - 1].angular_rate).squaredNorm();
  }
  const double count = 3.0 * static_cast<double>(recording.noisy.size() - 1);
  EXPECT_NEAR(std::sqrt(white / count),
              model.gyroscope_density * std::sqrt(200),
              0.03 * model.gyroscope_density * std::sqrt(200));
  EXPECT_NEAR(std::sqrt(walk / count),
              model.gyroscope_walk / std::sqrt(200),
              0.03 * model.gyroscope_walk / std::sqrt(200));
}

// A model with one fault.
template <class T>
ImuModel With(T ImuFaults::*fault, T value) {
  ImuModel model;
  model.faults.*fault = value;
  return model;
}

TEST(RecordImu, BiasesAtTurnOnAreConstant) {
  const auto still = [](double) { return Rigid3{}; };
  const ImuRecording recording = RecordImu(still, 2, With(&ImuFaults::bias, 1.0), 0, 1);
  const Vector3d rate = recording.noisy.front().angular_rate;
  const Vector3d force = recording.noisy.front().specific_force - Vector3d(0, 0, 9.81);
  EXPECT_GT(rate.norm(), 0.02);
  EXPECT_LT(rate.norm(), 0.3);
  EXPECT_GT(force.norm(), 0.04);
  EXPECT_LT(force.norm(), 0.6);
  EXPECT_EQ(recording.noisy.back().angular_rate, rate);
  EXPECT_EQ(recording.biases.back().angular_rate, rate);
  EXPECT_NE(RecordImu(still, 2, With(&ImuFaults::bias, 1.0), 0, 2).noisy.front().angular_rate,
            rate);
}

TEST(RecordImu, MeansAreThoseOfTheInterval) {
  // Turning at 10 cos(100 t) rad/s: over 5 ms the mean falls short of the instant by sinc(0.25).
  const auto shaken = [](double t) {
    return Rigid3{ExpSo3({0, 0, 0.1 * std::sin(100 * t)}), Vector3d::Zero()};
  };
  const ImuRecording recording = RecordImu(shaken, 1, With(&ImuFaults::average, true), 0, 1);
  for (std::size_t i = 0; i < recording.ideal.size(); ++i) {
    EXPECT_NEAR(recording.noisy[i].angular_rate.z(),
                recording.ideal[i].angular_rate.z() * std::sin(0.25) / 0.25,
                0.01);
  }
}

TEST(RecordImu, StampsAreOffAndSamplesMissing) {
  const ImuRecording offset = RecordImu(OnCircle, 10, With(&ImuFaults::offset_ms, -12.0), 1, 1);
  EXPECT_NEAR(offset.noisy.front().time, -0.012, 1e-12);
  EXPECT_EQ(offset.ideal.front().time, 0);
  const ImuRecording jitter = RecordImu(OnCircle, 10, With(&ImuFaults::jitter_ms, 2.0), 1, 1);
  double most = 0;
  for (std::size_t i = 0; i < jitter.noisy.size(); ++i) {
    most = std::max(most, std::abs(jitter.noisy[i].time - jitter.ideal[i].time));
  }
  EXPECT_GT(most, 1.9e-3);
  EXPECT_LE(most, 2e-3);
  const ImuRecording gaps = RecordImu(OnCircle, 10, With(&ImuFaults::gap_ms, 500.0), 1, 1);
  EXPECT_NEAR(static_cast<double>(gaps.noisy.size()), 2001 - 5 * 100, 5);
  const ImuRecording lost = RecordImu(OnCircle, 10, With(&ImuFaults::lost, 0.02), 1, 1);
  EXPECT_NEAR(static_cast<double>(lost.noisy.size()), 2001 * 0.98, 20);
  const ImuRecording margin = RecordImu(OnCircle, 10, With(&ImuFaults::margin_s, 0.5), 1, 1);
  EXPECT_NEAR(margin.noisy.front().time, -0.5, 1e-12);
  EXPECT_NEAR(margin.noisy.back().time, 10.5, 1e-9);
}

TEST(RecordImu, RangesClipAndAxesAreNotSquare) {
  const ImuRecording narrow = RecordImu(OnCircle, 1, With(&ImuFaults::rate_range, 0.5), 0, 1);
  EXPECT_EQ(narrow.noisy.front().angular_rate.z(), 0.5);
  const ImuRecording weak = RecordImu(OnCircle, 1, With(&ImuFaults::force_range, 9.0), 0, 1);
  EXPECT_EQ(weak.noisy.front().specific_force.z(), 9.0);
  const ImuRecording skewed = RecordImu(OnCircle, 1, With(&ImuFaults::axes, 1.0), 0, 1);
  const Vector3d off = skewed.noisy.front().angular_rate - Vector3d(0, 0, 0.7);
  EXPECT_GT(off.norm(), 1e-3);
  EXPECT_LT(off.norm(), 0.02);
}

}  // namespace
}  // namespace plumbline
