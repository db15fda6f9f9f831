// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/inertial/inertial_calibration_file.h"

#include "plumbline/io/cameras/camera_file.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace inertial_calibration_file_test {

// The place of one sensor at one camera: camera from sensor, and sensor from camera.
const std::string kCamFromImu = "[0, -1, 0, 0.05, 1, 0, 0, -0.02, 0, 0, 1, 0.01, 0, 0, 0, 1]";
const std::string kImuFromCam = "[0, 1, 0, 0.02, -1, 0, 0, 0.05, 0, 0, 1, -0.01, 0, 0, 0, 1]";
const std::string kDensities =
    "gyroscope_noise_density: 1.7e-4\ngyroscope_random_walk: 1.9e-5\n"
    "accelerometer_noise_density: 2.0e-3\naccelerometer_random_walk: 3.0e-3\n";

std::string Indented(const std::string& text, const std::string& by = "  ") {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    out += by + text.substr(at, end - at) + "\n";
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return out;
}

std::optional<InertialCalibration> Parse(const std::string& yaml,
                                         const std::optional<Rigid3>& body_from_left = {}) {
  return ParseInertialCalibration(YamlSection::Parse(yaml, "f.yaml"), body_from_left);
}

void ExpectThePlace(const std::optional<InertialCalibration>& calibration) {
  ASSERT_TRUE(calibration && calibration->imu_from_left);
  const Rigid3& place = *calibration->imu_from_left;
  EXPECT_LT((place * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(2.02, -0.95, 2.99)).norm(), 1e-9);
}

void ExpectTheNoise(const std::optional<InertialCalibration>& calibration) {
  ASSERT_TRUE(calibration && calibration->noise);
  EXPECT_EQ(calibration->noise->gyroscope_noise_density, 1.7e-4);
  EXPECT_EQ(calibration->noise->gyroscope_random_walk, 1.9e-5);
  EXPECT_EQ(calibration->noise->accelerometer_noise_density, 2.0e-3);
  EXPECT_EQ(calibration->noise->accelerometer_random_walk, 3.0e-3);
}

TEST(ParseInertialCalibration, ReadsASectionOfOurs) {
  const auto read =
      Parse("size: [8, 6]\nimu:\n  imu_from_left: " + kImuFromCam + "\n" + Indented(kDensities) +
            "  time_offset: -0.003\n  rate_hz: 200\n  gyroscope_range: 17\n");
  ExpectThePlace(read);
  ExpectTheNoise(read);
  EXPECT_EQ(read->time_offset, -0.003);
  EXPECT_EQ(read->rate_hz, 200);
  EXPECT_EQ(read->range.gyroscope, 17);
  EXPECT_TRUE(std::isinf(read->range.accelerometer));
}

TEST(ParseInertialCalibration, NeedsNoNumberBesideAnother) {
  const auto range = Parse("imu:\n  gyroscope_range: 17\n");
  ASSERT_TRUE(range);
  EXPECT_EQ(range->range.gyroscope, 17);
  EXPECT_FALSE(range->noise);
  EXPECT_EQ(Parse("imu:\n  accelerometer_range: 157\n")->range.accelerometer, 157);
}

TEST(ParseInertialCalibration, ReadsChainsOfKalibrAndOpenVins) {
  const auto kalibr =
      Parse("cam0:\n  T_cam_imu: " + kCamFromImu + "\n  timeshift_cam_imu: 0.0042\n");
  ExpectThePlace(kalibr);
  EXPECT_EQ(kalibr->time_offset, 0.0042);
  EXPECT_FALSE(kalibr->noise);
  ExpectThePlace(Parse("cam0:\n  T_imu_cam: " + kImuFromCam + "\n"));
  EXPECT_FALSE(Parse("cam0:\n  camera_model: pinhole\n"));
}

TEST(ParseInertialCalibration, ReadsImuFilesOfKalibrOpenVinsAndEuroc) {
  const auto kalibr = Parse("rostopic: /imu0\nupdate_rate: 200.0\n" + kDensities);
  ExpectTheNoise(kalibr);
  EXPECT_EQ(kalibr->rate_hz, 200);
  EXPECT_FALSE(kalibr->imu_from_left);
  const std::string unit = "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n";
  ExpectTheNoise(Parse("%YAML:1.0\nimu0:\n" + Indented(kDensities) + "  Tw: " + unit +
                       "  Ta: " + unit + "  Tg: [[0, 0, 0], [0, 0, 0], [0, 0, 0]]\n"));
  const std::string euroc =
      "sensor_type: imu\nT_BS:\n  cols: 4\n  rows: 4\n  data: " + kCamFromImu + "\nrate_hz: 200\n" +
      kDensities;
  ExpectTheNoise(Parse(euroc));
  EXPECT_FALSE(Parse(euroc)->imu_from_left);
  ExpectThePlace(Parse(euroc, Rigid3{}));
}

TEST(ParseInertialCalibration, ReadsSettingsOfOrbSlam) {
  const std::string noise =
      "IMU.NoiseGyro: 1.7e-4\nIMU.NoiseAcc: 2.0e-3\nIMU.GyroWalk: 1.9e-5\nIMU.AccWalk: 3.0e-3\n"
      "IMU.Frequency: 200.0\n";
  for (const std::string key : {"IMU.T_b_c1", "Tbc"}) {
    const auto read = Parse(
        "%YAML:1.0\nCamera.fx: 400\n" + key +
        ": !!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: f\n  data: " + kImuFromCam + "\n" + noise);
    ExpectThePlace(read);
    ExpectTheNoise(read);
    EXPECT_EQ(read->rate_hz, 200);
  }
}

TEST(ParseInertialCalibration, RefusesByName) {
  struct Case {
    std::string yaml, message;
  };
  const std::string imu = "imu:\n";
  const std::vector<Case> cases = {
      {"acc_n: 0.08\ngyr_n: 0.004\n",
       "f.yaml:1: acc_n: expected densities of continuous time by Kalibr's names "
       "(gyroscope_noise_density, ...), found a deviation of VINS, which is of discrete time"},
      {imu + "  gyroscope_noise_density: 1.7\n",
       "f.yaml:2: imu.gyroscope_noise_density: expected from 1e-07 to 0.1 rad/s/sqrt(Hz), found "
       "1.7"},
      {imu + "  gyroscope_noise_density: 1.7e-4\n",
       "f.yaml:2: imu.gyroscope_noise_density: expected all four densities or none, found no "
       "accelerometer_random_walk"},
      {imu + "  gyroscope_noise: 1.7e-4\n",
       "f.yaml:2: unknown key 'imu.gyroscope_noise'; did you mean 'gyroscope_noise_density'?"},
      {imu + "  time_offset: 3000\n",
       "f.yaml:2: imu.time_offset: expected from -10 to 10 s, found 3000"},
      {imu + "  rate_hz: 0\n", "f.yaml:2: imu.rate_hz: expected from 1 to 100000 Hz, found 0"},
      {"imu: 5\n", "f.yaml:1: imu: expected a group of keys, found '5'"},
      {imu + "  gyroscope_range: 0\n",
       "f.yaml:2: imu.gyroscope_range: expected from 0.1 to 1000 rad/s, found 0"}};
  for (const auto& [yaml, message] : cases) {
    EXPECT_EQ(MessageOf([&] { Parse(yaml); }), message) << yaml;
  }
  // A motion of the other direction is no key here.
  const std::string other = MessageOf([&] { Parse(imu + "  left_from_imu: " + kImuFromCam); });
  EXPECT_EQ(other, "f.yaml:2: unknown key 'imu.left_from_imu'");
  const std::string scaled = MessageOf([&] {
    Parse("imu0:\n" + Indented(kDensities) + "  Ta: [[1.01, 0, 0], [0, 1, 0], [0, 0, 1]]\n");
  });
  EXPECT_NE(scaled.find("Ta: expected the identity, found others"), std::string::npos) << scaled;
}

TEST(ReadInertialCalibration, RefusesAFileWithoutASensor) {
  const ScratchFolder folder;
  const std::string file = folder.Write("c.yaml", "size: [8, 6]\n").string();
  EXPECT_EQ(MessageOf([&] { ReadInertialCalibration(file); }),
            file +
                ": expected an inertial sensor (imu:, T_cam_imu, gyroscope_noise_density or "
                "IMU.NoiseGyro), found none");
}

TEST(FormatInertialCalibration, IsReadBackTheSame) {
  Rng rng(1);
  InertialCalibration calibration;
  calibration.imu_from_left = RandomRigid(rng);
  calibration.noise = InertialNoise{};
  calibration.range.accelerometer = 156.9;
  calibration.time_offset = 0.1 / 3;
  calibration.rate_hz = 199.7;
  const auto read = Parse(FormatInertialCalibration(calibration));
  ASSERT_TRUE(read && read->imu_from_left && read->noise);
  EXPECT_LT((read->imu_from_left->Matrix() - calibration.imu_from_left->Matrix()).norm(), 1e-14);
  EXPECT_EQ(read->noise->gyroscope_noise_density, calibration.noise->gyroscope_noise_density);
  EXPECT_EQ(read->range.accelerometer, 156.9);
  EXPECT_EQ(read->time_offset, calibration.time_offset);
  EXPECT_EQ(read->rate_hz, 199.7);
}

TEST(Completed, FillsInWhatIsNotTold) {
  InertialCalibration over, under;
  over.time_offset = 1;
  under.time_offset = 2;
  under.rate_hz = 3;
  over.range.gyroscope = 17;
  under.range = {35, 157};
  const InertialCalibration all = Completed(over, under);
  EXPECT_EQ(all.time_offset, 1);
  EXPECT_EQ(all.rate_hz, 3);
  EXPECT_FALSE(all.noise);
  EXPECT_EQ(all.range.gyroscope, 17);
  EXPECT_EQ(all.range.accelerometer, 157);
}

TEST(ParseCamera, AcceptsASectionOfAnInertialSensor) {
  const Calibration camera = ParseCamera(
      "size: [752, 480]\nintrinsics: [400, 400, 370, 240]\nimu:\n  rate_hz: 200\n", "c.yaml");
  EXPECT_EQ(camera.left.width(), 752);
}

}  // namespace inertial_calibration_file_test
}  // namespace plumbline
