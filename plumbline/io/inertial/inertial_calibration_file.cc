// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/inertial/inertial_calibration_file.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/geometry/calibration.h"

#include <array>
#include <cmath>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

// A density with the values that a real sensor can have, from the best to far beyond the worst.
struct Density {
  const char* name;      // Kalibr's, EuRoC's and ours
  const char* orb_slam;  // ORB-SLAM3's
  double InertialNoise::*member;
  double least, most;
  const char* unit;
};
constexpr std::array<Density, 4> kDensities = {{
    {"gyroscope_noise_density",
     "IMU.NoiseGyro",
     &InertialNoise::gyroscope_noise_density,
     1e-7,
     0.1,
     "rad/s/sqrt(Hz)"},
    {"gyroscope_random_walk",
     "IMU.GyroWalk",
     &InertialNoise::gyroscope_random_walk,
     1e-10,
     0.1,
     "rad/s^2/sqrt(Hz)"},
    {"accelerometer_noise_density",
     "IMU.NoiseAcc",
     &InertialNoise::accelerometer_noise_density,
     1e-6,
     1,
     "m/s^2/sqrt(Hz)"},
    {"accelerometer_random_walk",
     "IMU.AccWalk",
     &InertialNoise::accelerometer_random_walk,
     1e-9,
     1,
     "m/s^3/sqrt(Hz)"},
}};

double NumberWithin(const YamlSection& section,
                    const std::string& key,
                    double least,
                    double most,
                    const char* unit) {
  const double number = section.Number(key);
  if (!(number >= least && number <= most)) {
    section.Fail(
        key, fmt::format("expected from {:g} to {:g} {}, found {:g}", least, most, unit, number));
  }
  return number;
}

// Reads the four densities, if any of them is there.
std::optional<InertialNoise> ReadNoise(const YamlSection& section, const char* Density::*name) {
  const char *there = nullptr, *missing = nullptr;
  InertialNoise noise;
  for (const Density& density : kDensities) {
    const char* key = density.*name;
    (section.Has(key) ? there : missing) = key;
    if (!section.Has(key)) continue;
    noise.*density.member = NumberWithin(section, key, density.least, density.most, density.unit);
  }
  if (there == nullptr) return std::nullopt;
  if (missing != nullptr) {
    section.Fail(there, fmt::format("expected all four densities or none, found no {}", missing));
  }
  return noise;
}

std::optional<double> ReadRate(const YamlSection& section, const std::string& key) {
  if (!section.Has(key)) return std::nullopt;
  return NumberWithin(section, key, 1, 100'000, "Hz");
}

std::optional<double> ReadTimeOffset(const YamlSection& section, const std::string& key) {
  if (!section.Has(key)) return std::nullopt;
  return NumberWithin(section, key, -10, 10, "s");
}

Rigid3 ReadPlace(const YamlSection& section, const std::string& key) {
  const Rigid3 place = section.Motion(key);
  if (const auto fault = LeverFault(place)) section.Fail(key, *fault);
  return place;
}

// The section of a camera file of ours.
InertialCalibration ReadOwnSection(const YamlSection& imu) {
  std::vector<std::string> known = {
      "imu_from_left", "time_offset", "rate_hz", "gyroscope_range", "accelerometer_range"};
  for (const Density& density : kDensities) known.emplace_back(density.name);
  imu.RejectUnknown(known);
  InertialCalibration calibration;
  if (imu.Has("imu_from_left")) calibration.imu_from_left = ReadPlace(imu, "imu_from_left");
  calibration.time_offset = ReadTimeOffset(imu, "time_offset");
  calibration.rate_hz = ReadRate(imu, "rate_hz");
  calibration.noise = ReadNoise(imu, &Density::name);
  for (const char* key : {"gyroscope_range", "accelerometer_range"}) {
    if (!imu.Has(key)) continue;
    const bool gyroscope = key[0] == 'g';
    (gyroscope ? calibration.range.gyroscope : calibration.range.accelerometer) =
        NumberWithin(imu, key, 0.1, gyroscope ? 1000 : 100'000, gyroscope ? "rad/s" : "m/s^2");
  }
  return calibration;
}

std::optional<InertialCalibration> ReadChain(const YamlSection& cam0) {
  InertialCalibration calibration;
  if (cam0.Has("T_cam_imu")) {
    calibration.imu_from_left = Inverse(ReadPlace(cam0, "T_cam_imu"));
  } else if (cam0.Has("T_imu_cam")) {
    calibration.imu_from_left = ReadPlace(cam0, "T_imu_cam");
  }
  calibration.time_offset = ReadTimeOffset(cam0, "timeshift_cam_imu");
  if (!calibration.imu_from_left && !calibration.time_offset) return std::nullopt;
  return calibration;
}

// Refuses models of scale and misalignment, which are not used here.
void CheckPlainModel(const YamlSection& imu) {
  for (const char* key : {"Tw", "Ta", "R_IMUtoGYRO", "R_IMUtoACC", "Tg"}) {
    if (!imu.Has(key)) continue;
    const bool zero = key == std::string("Tg");
    const Eigen::MatrixXd none = zero ? Eigen::MatrixXd(Eigen::Matrix3d::Zero())
                                      : Eigen::MatrixXd(Eigen::Matrix3d::Identity());
    if ((imu.Matrix(key, 3, 3) - none).cwiseAbs().maxCoeff() < 1e-9) continue;
    imu.Fail(key,
             fmt::format("expected {}, found others: scale and misalignment of a sensor are not "
                         "used; correct its samples, or give what they are without",
                         zero ? "zeros" : "the identity"));
  }
  for (const char* key : {"gyroscopes", "accelerometers"}) {
    if (!imu.Has(key)) continue;
    imu.Fail(key,
             "expected none, found a model of scale and misalignment, which is not used; calibrate "
             "with --imu-models calibrated");
  }
}

InertialCalibration ReadImuFile(const YamlSection& imu,
                                const std::optional<Rigid3>& body_from_left) {
  CheckPlainModel(imu);
  InertialCalibration calibration;
  calibration.noise = ReadNoise(imu, &Density::name);
  calibration.rate_hz = ReadRate(imu, imu.Has("update_rate") ? "update_rate" : "rate_hz");
  if (imu.Has("T_BS") && body_from_left) {
    const YamlSection matrix = imu.Child("T_BS");
    calibration.imu_from_left = Inverse(ReadPlace(matrix, "data")) * *body_from_left;
  }
  return calibration;
}

InertialCalibration ReadOrbSlam(const YamlSection& root) {
  InertialCalibration calibration;
  for (const char* key : {"Tbc", "IMU.T_b_c1"}) {
    if (root.Has(key)) calibration.imu_from_left = ReadPlace(root, key);
  }
  calibration.noise = ReadNoise(root, &Density::orb_slam);
  calibration.rate_hz = ReadRate(root, "IMU.Frequency");
  return calibration;
}

bool HasAnyDensity(const YamlSection& section, const char* Density::*name) {
  for (const Density& density : kDensities) {
    if (section.Has(density.*name)) return true;
  }
  return false;
}

void RefuseVins(const YamlSection& root) {
  for (const char* key : {"acc_n", "gyr_n", "acc_w", "gyr_w"}) {
    if (!root.Has(key)) continue;
    root.Fail(key,
              "expected densities of continuous time by Kalibr's names (gyroscope_noise_density, "
              "...), found a deviation of VINS, which is of discrete time");
  }
}

}  // namespace

std::optional<InertialCalibration> ParseInertialCalibration(
    const YamlSection& root, const std::optional<Rigid3>& body_from_left) {
  RefuseVins(root);
  if (root.Has("imu")) return ReadOwnSection(root.Child("imu"));
  if (root.Has("cam0")) return ReadChain(root.Child("cam0"));
  if (root.Has("imu0")) return ReadImuFile(root.Child("imu0"), body_from_left);
  if (HasAnyDensity(root, &Density::name)) return ReadImuFile(root, body_from_left);
  if (HasAnyDensity(root, &Density::orb_slam) || root.Has("IMU.T_b_c1") || root.Has("Tbc")) {
    return ReadOrbSlam(root);
  }
  return std::nullopt;
}

InertialCalibration ReadInertialCalibration(const std::filesystem::path& path,
                                            const std::optional<Rigid3>& body_from_left) {
  const YamlSection root = YamlSection::Parse(ReadInputFile(path, kLargestSettings), path.string());
  if (const auto calibration = ParseInertialCalibration(root, body_from_left)) return *calibration;
  throw InputError(
      path.string() +
      ": expected an inertial sensor (imu:, T_cam_imu, gyroscope_noise_density or IMU.NoiseGyro), "
      "found none");
}

void CheckPlaceIsKnown(const InertialCalibration& calibration, const std::string& source) {
  if (calibration.imu_from_left) return;
  throw InputError(source +
                   ": expected the place of the sensor at the camera (imu_from_left of a camera "
                   "file, T_cam_imu of Kalibr), found none");
}

InertialCalibration Completed(const InertialCalibration& over, const InertialCalibration& under) {
  InertialCalibration all = over;
  if (!all.imu_from_left) all.imu_from_left = under.imu_from_left;
  if (!all.noise) all.noise = under.noise;
  if (!all.time_offset) all.time_offset = under.time_offset;
  if (!all.rate_hz) all.rate_hz = under.rate_hz;
  if (std::isinf(all.range.gyroscope)) all.range.gyroscope = under.range.gyroscope;
  if (std::isinf(all.range.accelerometer)) all.range.accelerometer = under.range.accelerometer;
  return all;
}

std::string FormatInertialCalibration(const InertialCalibration& calibration) {
  std::string out = "imu:\n";
  if (calibration.imu_from_left) {
    std::vector<double> numbers;
    const Eigen::Matrix4d matrix = calibration.imu_from_left->Matrix();
    for (int i = 0; i < 16; ++i) numbers.push_back(matrix(i / 4, i % 4));
    out += fmt::format("  imu_from_left: [{}]\n", fmt::join(numbers, ", "));
  }
  const auto row = [&](const char* key, double number) {
    out += fmt::format("  {}: {}\n", key, number);
  };
  if (calibration.noise) {
    const InertialNoise& noise = *calibration.noise;
    for (const Density& density : kDensities) row(density.name, noise.*density.member);
  }
  const InertialRange& range = calibration.range;
  if (std::isfinite(range.gyroscope)) row("gyroscope_range", range.gyroscope);
  if (std::isfinite(range.accelerometer)) row("accelerometer_range", range.accelerometer);
  if (calibration.time_offset) row("time_offset", *calibration.time_offset);
  if (calibration.rate_hz) row("rate_hz", *calibration.rate_hz);
  return out;
}

}  // namespace plumbline
