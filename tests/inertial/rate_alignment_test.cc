// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/rate_alignment.h"

#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"

#include "tests/inertial/invented_motion.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const Eigen::Quaterniond kMount = ExpSo3({0.4, -1.2, 0.7});  // imu_from_camera

// Poses of a camera at 20 Hz for 12 s on IdealSample's motion, off by 0.03 degrees, and samples
// whose clock is ahead by an offset. `turning` scales the motion.
struct Recorded {
  Trajectory camera;
  std::vector<InertialSample> samples;
};
Recorded Record(double offset, double turning = 1) {
  Rng rng(1);
  Recorded recorded;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  // world_from_imu
  constexpr double kStep = 1e-3;
  for (int i = -1000; i <= 13000; ++i) {
    const double t = i * kStep;
    InertialSample sample = IdealSample(t);
    sample.angular_rate *= turning;
    if (i >= 0 && i <= 12000 && i % 50 == 0) {
      const Eigen::Quaterniond camera = turn * kMount * ExpSo3(RandomVector<3>(rng, 5e-4));
      recorded.camera.push_back({sample.stamp_ns, {camera, Eigen::Vector3d::Zero()}});
    }
    turn = (turn * ExpSo3(kStep * turning * IdealSample(t + kStep / 2).angular_rate)).normalized();
    if (i % 5 != 0) continue;
    sample.stamp_ns += std::llround(offset * kNsPerSecond);
    sample.angular_rate += Eigen::Vector3d(0.02, -0.01, 0.03) + RandomVector<3>(rng, 2.4e-3);
    recorded.samples.push_back(sample);
  }
  return recorded;
}

TEST(AlignRates, FindsRotationOffsetAndBias) {
  for (const double offset : {-0.03, -0.0042, 0.0, 0.011, 0.03, 0.2}) {
    const Recorded recorded = Record(offset);
    const auto found = AlignRates(recorded.camera, recorded.samples);
    ASSERT_TRUE(found) << offset;
    EXPECT_NEAR(found->time_offset, offset, 1e-3);
    EXPECT_LT(std::abs(found->time_offset - offset), 5 * found->time_offset_sigma + 1e-4);
    EXPECT_LT(AngularDistance(found->imu_from_camera, kMount), 0.3 * kDegree);
    EXPECT_LT((found->gyroscope_bias - Eigen::Vector3d(0.02, -0.01, 0.03)).norm(), 2e-3);
  }
}

TEST(AlignRates, FindsNothingAtRestNorOfLittle) {
  const Recorded rest = Record(0.01, 0);
  EXPECT_FALSE(AlignRates(rest.camera, rest.samples));
  const Recorded all = Record(0.01);
  EXPECT_FALSE(AlignRates(all.camera, {}));
  EXPECT_FALSE(AlignRates({}, all.samples));
  EXPECT_FALSE(AlignRates(Trajectory(all.camera.begin(), all.camera.begin() + 15), all.samples));
}

TEST(AlignmentFaults, NamesWhatIsRight) {
  const Recorded recorded = Record(0.0123);
  const auto found = AlignRates(recorded.camera, recorded.samples);
  ASSERT_TRUE(found);
  InertialCalibration calibration;
  calibration.imu_from_left = Rigid3{kMount, {0.1, 0, 0}};
  calibration.time_offset = 0.0123;
  EXPECT_TRUE(AlignmentFaults(*found, calibration).empty());
  for (const double degrees : {5.0, 90.0}) {
    calibration.imu_from_left->rotation = kMount * ExpSo3({0, degrees * kDegree, 0});
    const auto faults = AlignmentFaults(*found, calibration);
    ASSERT_EQ(faults.size(), 1U);
    // All 16 numbers, as the key takes them.
    const std::string key = "imu_from_left: [";
    const std::size_t at = faults[0].find(key);
    ASSERT_NE(at, std::string::npos) << faults[0];
    std::istringstream numbers(faults[0].substr(at + key.size()));
    Eigen::Matrix4d matrix;
    for (int i = 0; i < 16; ++i) {
      char separator = 0;
      ASSERT_TRUE(numbers >> matrix(i / 4, i % 4) >> separator);
      EXPECT_EQ(separator, i < 15 ? ',' : ']');
    }
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    EXPECT_LT(AngularDistance(Eigen::Quaterniond(rotation), kMount), 0.3 * kDegree);
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-4);
    EXPECT_EQ(matrix.col(3), Eigen::Vector4d(0.1, 0, 0, 1));
    EXPECT_EQ(matrix.row(3), Eigen::RowVector4d(0, 0, 0, 1));
  }
  calibration.imu_from_left.reset();
  calibration.time_offset = -0.01;
  const auto faults = AlignmentFaults(*found, calibration);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_TRUE(faults[0].starts_with("time_offset is -0.0100 s, but 0.012")) << faults[0];
}

}  // namespace
}  // namespace plumbline
