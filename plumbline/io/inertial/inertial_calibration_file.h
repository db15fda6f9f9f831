// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/io/cameras/yaml_section.h"

#include <filesystem>
#include <optional>
#include <string>

namespace plumbline {

// Reads what a file tells of an inertial sensor: its place at the camera, its noise, its clock, or
// some of them. The form is known by its keys:
//
//   imu:                                    # in a camera file of ours (camera_file.h)
//     imu_from_left: [16 numbers]           # 4x4, row by row, metres
//     gyroscope_noise_density: 1.7e-4       # rad/s/sqrt(Hz); all four or none
//     gyroscope_random_walk: 1.9e-5         # rad/s^2/sqrt(Hz)
//     accelerometer_noise_density: 2.0e-3   # m/s^2/sqrt(Hz)
//     accelerometer_random_walk: 3.0e-3     # m/s^3/sqrt(Hz)
//     time_offset: 0.003                    # s, stamp of the sensor = stamp of the camera + this
//     rate_hz: 200                          # all of these are optional
//     gyroscope_range: 17                   # rad/s
//     accelerometer_range: 157              # m/s^2
//
//   Kalibr's camchain-imucam.yaml, OpenVINS' kalibr_imucam_chain.yaml
//                 cam0: T_cam_imu (from sensor to camera) or T_imu_cam; timeshift_cam_imu
//   Kalibr's imu.yaml, OpenVINS' kalibr_imu_chain.yaml
//                 the four densities, update_rate, also in imu0; models of scale and misalignment
//                 (Tw, Ta, Tg, R_IMUtoGYRO, R_IMUtoACC) must be none
//   EuRoC's imu0/sensor.yaml
//                 the four densities, rate_hz, T_BS (from sensor to body), which needs
//                 body_from_left
//   settings of ORB-SLAM3
//                 IMU.T_b_c1 or Tbc (from camera to sensor), IMU.NoiseGyro, IMU.NoiseAcc,
//                 IMU.GyroWalk, IMU.AccWalk, IMU.Frequency
//
// Densities are of continuous time. VINS' acc_n, which are of discrete time, are refused.
//
// Returns nullopt if the file tells nothing of a sensor. Throws InputError "source:line: key:
// expected ..., found ...".
std::optional<InertialCalibration> ParseInertialCalibration(
    const YamlSection& root, const std::optional<Rigid3>& body_from_left = std::nullopt);

// Reads the file at a path. A file that tells nothing of a sensor is an InputError.
InertialCalibration ReadInertialCalibration(
    const std::filesystem::path& path, const std::optional<Rigid3>& body_from_left = std::nullopt);

// Throws InputError, which begins with `source`, if the place of the sensor is not known.
void CheckPlaceIsKnown(const InertialCalibration& calibration, const std::string& source);

// Returns what `over` tells, and what only `under` tells.
InertialCalibration Completed(const InertialCalibration& over, const InertialCalibration& under);

// Returns a calibration as the section `imu:` of a camera file; ParseInertialCalibration restores
// the same numbers.
std::string FormatInertialCalibration(const InertialCalibration& calibration);

}  // namespace plumbline
