// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/inertial/inertial_samples.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/inertial/inertial_stream.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// An inertial sensor of a sequence, or of a live source, and what it measured.
struct InertialRecording {
  // All samples of a sequence, or the first ones (InertialOptions::seconds).
  OrderedSamples ordered;
  bool complete = true;  // false: only the first ones
  // Opens all samples of a sequence, from the first one on. Empty for a live source.
  std::function<std::unique_ptr<InertialStream>()> open;
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
  // How much to read at once, from the first sample on.
  double seconds = std::numeric_limits<double>::infinity();
  std::size_t most = std::numeric_limits<std::size_t>::max();  // samples
};

// Finds the samples of a sequence: of EuRoC's form mav0/imu0/data.csv, of other folders imu.csv, of
// a recording the topic of sensor_msgs/Imu, or the two of a gyroscope and an accelerometer that are
// sampled apart, which are joined (JoinedSamples). Of several sensors the first by name that
// measures both is taken, with a note.
//
// Calibration, by the first that tells: options.imu, options.camera, a camera file in the folder or
// beside a file (CameraFileIn), EuRoC's imu0/sensor.yaml with that of cam0.
//
// Samples that cannot be used are left out, with a note. Returns nullopt if there are no samples.
// Throws InputError where more samples cannot be used than can, and for files that are malformed,
// or where a folder or a pipe has the name of the file.
std::optional<InertialRecording> FindInertial(const std::filesystem::path& path,
                                              DatasetFormat format,
                                              const InertialOptions& options);

// Returns true if a path has samples alone: a .csv file, or a folder imu0 of EuRoC's form.
bool IsInertialAlone(const std::filesystem::path& path);

// Reads a path of IsInertialAlone. Throws like FindInertial.
InertialRecording OpenInertialAlone(const std::filesystem::path& path,
                                    const InertialOptions& options);

// Returns the sensor of a sequence whose samples a caller has. Calibration: as of FindInertial.
InertialRecording DescribeGivenInertial(std::vector<InertialSample> samples,
                                        const std::filesystem::path& path,
                                        DatasetFormat format,
                                        const InertialOptions& options);

// Returns the sensor of a live source of this name, with what the files of the options tell.
InertialRecording DescribeLiveInertial(const std::string& source, const InertialOptions& options);

}  // namespace plumbline
