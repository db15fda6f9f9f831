// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/inertial/inertial_samples.h"
#include "plumbline/io/datasets/dataset.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// What an inertial sensor measured beside the images of a sequence.
struct InertialRecording {
  OrderedSamples ordered;
  std::string source;  // "FILE", or "/imu0 of FILE"; of two topics both
  InertialCalibration calibration;
  std::string calibration_source;  // for display; empty if nothing is known
  std::vector<std::string> notes;  // one sentence for each missing part
};

// Which samples and calibration to take.
struct InertialOptions {
  // A calibration (inertial_calibration_file.h); what it does not tell is looked for with the data.
  std::optional<std::string> imu = std::nullopt;
  // A camera file named by users: it may tell of the sensor.
  std::optional<std::string> camera = std::nullopt;
  // Topics of a recording named by users; those of an inertial sensor are taken.
  std::vector<std::string> topics = {};
};

// Samples of a file, and what of it could not be used.
struct InertialRows {
  std::vector<InertialSample> samples;  // in the order of the file
  std::size_t unusable = 0;             // rows that are no samples and are left out
  std::string first_fault;              // "FILE:LINE: expected ..., found ..." of the first of them
};

// Reads rows of STAMP, three rates in rad/s and three forces in m/s^2, separated by commas, as the
// data.csv of EuRoC's imu0. Stamps are in nanoseconds, or with a decimal point in seconds. Throws
// InputError if more rows cannot be used than can.
InertialRows ReadInertialRows(const std::filesystem::path& file);

// Finds the samples of a sequence: of EuRoC's form mav0/imu0/data.csv, of other folders imu.csv,
// of a recording the topic of sensor_msgs/Imu, or the two of a gyroscope and an accelerometer that
// are sampled apart, which are joined (JoinedSamples). Of several sensors the first by name that
// measures both is taken, with a note. A topic measures no rates if all of them are zero or their
// covariance begins with -1, as ROS marks it; forces alike.
//
// Calibration, by the first that tells: options.imu, options.camera, a camera file in the folder or
// beside a file (CameraFileIn), EuRoC's imu0/sensor.yaml with that of cam0.
//
// Samples that cannot be used are left out, with a note. Returns nullopt if there are no samples.
// Throws InputError where most cannot be used, and for files that are malformed.
std::optional<InertialRecording> FindInertial(const std::filesystem::path& path,
                                              DatasetFormat format,
                                              const InertialOptions& options);

// Returns true if a path has samples alone: a .csv file, or a folder imu0 of EuRoC's form.
bool IsInertialAlone(const std::filesystem::path& path);

// Reads a path of IsInertialAlone. Throws like FindInertial.
InertialRecording OpenInertialAlone(const std::filesystem::path& path,
                                    const InertialOptions& options);

}  // namespace plumbline
