// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/inertial/inertial_sample.h"
#include "plumbline/io/datasets/dataset.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// What of the samples of a source could not be used, and was left out.
struct UnusableSamples {
  std::size_t count = 0;
  std::string first;  // "FILE:LINE: expected ..., found ..." of the first one; empty if not known
};

// Samples of a source, read as they are asked for: what is held does not grow with the length.
class InertialStream {
 public:
  InertialStream() = default;
  InertialStream(const InertialStream&) = delete;
  InertialStream& operator=(const InertialStream&) = delete;
  virtual ~InertialStream() = default;

  // Returns the next usable sample in the order of the source; nullopt at its end.
  virtual std::optional<InertialSample> Next() = 0;
  // What was left out so far.
  const UnusableSamples& unusable() const { return unusable_; }

 protected:
  UnusableSamples unusable_;
};

// Returns the sample that seven texts are, or "expected ..., found ...": a stamp in whole
// nanoseconds, or in seconds if it has a decimal point, three rates in rad/s, three forces in
// m/s^2.
Expected<InertialSample, std::string> ParseInertialSample(std::span<const std::string> fields);

// Opens rows of seven fields separated by commas, as the data.csv of EuRoC's imu0. Throws
// InputError if the file cannot be opened.
std::unique_ptr<InertialStream> OpenInertialRows(const std::filesystem::path& file);

// A message of an inertial sensor in a recording.
struct InertialReading {
  std::string topic;
  // Rates or forces that were not measured are zero. nullopt: the message is no measurement.
  std::optional<InertialSample> sample;
  bool has_rate = false, has_force = false;
};

// Reads a recording from its beginning and passes the messages of sensor_msgs/Imu to `sink` in the
// order of the file, until it returns false. A topic measures no rates if all of them are zero or
// their covariance begins with -1, as ROS marks it; forces alike. Throws the errors of ReadBag,
// ReadMcap and ReadRosbag2.
using InertialSink = std::function<bool(InertialReading)>;
void ReadInertialMessages(const std::filesystem::path& path,
                          DatasetFormat format,
                          const InertialSink& sink);

// The topics of a sensor in a recording.
struct InertialTopics {
  std::string gyroscope;
  std::string accelerometer;    // the same topic, or one that is sampled apart
  bool gyroscope_leads = true;  // of two topics, the gyroscope's is the faster one
};

// Opens the samples of a recording. A thread of its own reads ahead by some thousand messages.
// Topics apart are joined (SampleJoiner). A recording that cannot be read any more ends there.
std::unique_ptr<InertialStream> OpenInertialTopics(const std::filesystem::path& path,
                                                   DatasetFormat format,
                                                   const InertialTopics& topics);

}  // namespace plumbline
