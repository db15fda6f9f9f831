// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/inertial/inertial_recording.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/datasets/rosbag2_files.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"
#include "plumbline/io/recordings/image_message.h"
#include "plumbline/io/recordings/recording_formats.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr double kMostValue = 1e6;  // rad/s and m/s^2, beyond all sensors

bool IsFileThere(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

InertialSample SampleOf(const fs::path& file, const TextRow& row) {
  constexpr std::size_t kColumns = 7;
  if (row.fields.size() != kColumns) {
    FailAt(file,
           row.line,
           "a time stamp, three rates in rad/s and three forces in m/s^2",
           std::to_string(row.fields.size()) + " columns");
  }
  const bool seconds = row.fields[0].find('.') != std::string::npos;
  const auto stamp = seconds ? ParseSeconds(row.fields[0]) : ParseNanoseconds(row.fields[0]);
  if (!stamp) {
    FailAt(file,
           row.line,
           "a time stamp in whole nanoseconds, or in seconds with a decimal point",
           InQuotes(row.fields[0]));
  }
  InertialSample sample;
  sample.stamp_ns = *stamp;
  for (std::size_t k = 0; k < 6; ++k) {
    const double value = NumberField(file, row, 1 + k);
    if (std::abs(value) > kMostValue) {
      FailAt(file, row.line, "rates in rad/s and forces in m/s^2", InQuotes(row.fields[1 + k]));
    }
    const auto axis = static_cast<Eigen::Index>(k % 3);
    (k < 3 ? sample.angular_rate : sample.specific_force)(axis) = value;
  }
  return sample;
}

// The samples of a topic.
struct InertialTopic {
  std::vector<InertialSample> samples;
  bool has_rate = false, has_force = false;
  std::size_t broken = 0;
};
using InertialTopics = std::map<std::string, InertialTopic>;

void TakeMessage(const StoredMessage& place,
                 const std::optional<InertialMessage>& message,
                 InertialTopic& topic) {
  const auto usable = [](const std::array<double, 3>& v) {
    return std::all_of(v.begin(), v.end(), [](double x) { return std::abs(x) <= kMostValue; });
  };
  const auto is_time = [](std::int64_t ns) { return ns > 0 && ns <= kLatestStampNs; };
  InertialSample sample;
  sample.stamp_ns = message && is_time(message->stamp_ns) ? message->stamp_ns : place.logged_ns;
  if (!message || !usable(message->angular_rate) || !usable(message->specific_force) ||
      !is_time(sample.stamp_ns)) {
    ++topic.broken;
    return;
  }
  sample.angular_rate = Eigen::Map<const Eigen::Vector3d>(message->angular_rate.data());
  sample.specific_force = Eigen::Map<const Eigen::Vector3d>(message->specific_force.data());
  topic.has_rate = topic.has_rate || (message->has_rate && !sample.angular_rate.isZero(0));
  topic.has_force = topic.has_force || (message->has_force && !sample.specific_force.isZero(0));
  topic.samples.push_back(sample);
}

InertialTopics ReadInertialTopics(const fs::path& path, DatasetFormat format) {
  InertialTopics topics;
  const MessageSink sink =
      [&](const Channel& channel, const StoredMessage& place, std::span<const std::uint8_t> bytes) {
        const auto form = FormOf(channel);
        if (!form || form->kind != MessageKind::kInertial) return;
        const bool cdr = form->encoding == MessageEncoding::kCdr;
        const auto unpacked = UnpackedMessage(channel, bytes);
        std::optional<InertialMessage> message;
        if (!unpacked) message = ParseRosInertial(cdr, bytes);
        if (unpacked && *unpacked) message = ParseRosInertial(cdr, **unpacked);
        TakeMessage(place, message, topics[channel.topic]);
      };
  switch (format) {
    case DatasetFormat::kBag:
      ReadBag(path, sink);
      break;
    case DatasetFormat::kMcap:
      ReadMcap(path, sink);
      break;
    case DatasetFormat::kRosbag2:
      ReadRosbag2(path, FindRosbag2Files(path).files, sink);
      break;
    default:
      break;
  }
  return topics;
}

// Keeps the topics that users named, if they named one of an inertial sensor.
void KeepNamed(const std::vector<std::string>& names, InertialTopics& topics) {
  const auto named = [&](const auto& topic) {
    return std::find(names.begin(), names.end(), topic.first) != names.end();
  };
  if (std::none_of(topics.begin(), topics.end(), named)) return;
  std::erase_if(topics, [&](const auto& topic) { return !named(topic); });
}

using Topic = InertialTopics::value_type;

const Topic* First(const InertialTopics& topics, bool rate, bool force) {
  for (const Topic& topic : topics) {
    if (topic.second.has_rate == rate && topic.second.has_force == force) return &topic;
  }
  return nullptr;
}

// Notes messages that are left out; refuses a topic where they are the most.
void AddBroken(const Topic& topic, InertialRecording& recording) {
  if (topic.second.broken == 0) return;
  const std::size_t all = topic.second.broken + topic.second.samples.size();
  if (2 * topic.second.broken > all) {
    throw InputError(fmt::format("{}: expected measurements, found {} of {} messages that are none",
                                 recording.source,
                                 topic.second.broken,
                                 all));
  }
  recording.notes.push_back(fmt::format("{} messages of {} are no measurements and are left out",
                                        topic.second.broken,
                                        Printable(topic.first)));
}

std::optional<InertialRecording> FromTopics(const fs::path& path,
                                            DatasetFormat format,
                                            const InertialOptions& options) {
  InertialTopics topics = ReadInertialTopics(path, format);
  KeepNamed(options.topics, topics);
  InertialRecording recording;
  if (const Topic* both = First(topics, true, true)) {
    recording.ordered = InOrderOfTime(both->second.samples);
    recording.source = fmt::format("{} of {}", Printable(both->first), path.string());
    AddBroken(*both, recording);
    if (topics.size() > 1) {
      recording.notes.push_back(fmt::format("{} inertial sensors; {} is used, choose by --topic",
                                            topics.size(),
                                            Printable(both->first)));
    }
    return recording;
  }
  const Topic* gyroscope = First(topics, true, false);
  const Topic* accelerometer = First(topics, false, true);
  if (gyroscope == nullptr || accelerometer == nullptr) return std::nullopt;
  const OrderedSamples rates = InOrderOfTime(gyroscope->second.samples);
  const OrderedSamples forces = InOrderOfTime(accelerometer->second.samples);
  recording.ordered.samples = JoinedSamples(rates.samples, forces.samples);
  recording.ordered.backward = rates.backward + forces.backward;
  recording.ordered.repeated = rates.repeated + forces.repeated;
  recording.source = fmt::format("{} and {} of {}",
                                 Printable(gyroscope->first),
                                 Printable(accelerometer->first),
                                 path.string());
  AddBroken(*gyroscope, recording);
  AddBroken(*accelerometer, recording);
  return recording;
}

// Adds what a file tells of the sensor, if it does.
void AddCalibration(const fs::path& file,
                    const std::optional<Rigid3>& body_from_left,
                    bool wanted,
                    InertialRecording& recording) {
  std::optional<InertialCalibration> read;
  if (wanted) {
    read = ReadInertialCalibration(file, body_from_left);
  } else {
    const std::string text = ReadInputFile(file, kLargestSettings);
    if (IsColmapCameras(text)) return;
    read = ParseInertialCalibration(YamlSection::Parse(text, file.string()), body_from_left);
  }
  if (!read) return;
  recording.calibration = Completed(recording.calibration, *read);
  std::string& source = recording.calibration_source;
  source += (source.empty() ? "" : ", ") + file.string();
}

// `folder` is where a camera file of the data would be; `sensors` has EuRoC's imu0 and cam0.
void FindCalibration(const InertialOptions& options,
                     const fs::path& folder,
                     const std::optional<fs::path>& sensors,
                     InertialRecording& recording) {
  std::optional<Rigid3> body_from_left;
  if (sensors && IsFileThere(*sensors / "cam0" / "sensor.yaml")) {
    body_from_left = ReadEurocSensor(*sensors / "cam0" / "sensor.yaml").body_from_camera;
  }
  if (options.imu) AddCalibration(*options.imu, body_from_left, true, recording);
  if (options.camera && IsFileThere(*options.camera)) {
    AddCalibration(*options.camera, body_from_left, false, recording);
  }
  if (const auto file = CameraFileIn(folder)) {
    AddCalibration(*file, body_from_left, false, recording);
  }
  if (sensors && IsFileThere(*sensors / "imu0" / "sensor.yaml")) {
    AddCalibration(*sensors / "imu0" / "sensor.yaml", body_from_left, false, recording);
  }
}

InertialRecording FromRows(const fs::path& file) {
  InertialRecording recording;
  const InertialRows rows = ReadInertialRows(file);
  recording.ordered = InOrderOfTime(rows.samples);
  recording.source = file.string();
  if (rows.unusable > 0) {
    recording.notes.push_back(fmt::format("{} of {} rows are no samples and are left out; {}",
                                          rows.unusable,
                                          rows.unusable + rows.samples.size(),
                                          rows.first_fault));
  }
  return recording;
}

bool IsImuFolder(const fs::path& path) {
  return IsFileThere(path / "data.csv") && path.filename().string().starts_with("imu");
}

}  // namespace

InertialRows ReadInertialRows(const fs::path& file) {
  InertialRows rows;
  for (const TextRow& row : ReadRows(file, ',')) {
    try {
      rows.samples.push_back(SampleOf(file, row));
    } catch (const InputError& fault) {
      if (rows.unusable == 0) rows.first_fault = fault.what();
      ++rows.unusable;
    }
  }
  if (rows.unusable > rows.samples.size()) {
    throw InputError(fmt::format("{} ({} of {} rows are no samples)",
                                 rows.first_fault,
                                 rows.unusable,
                                 rows.unusable + rows.samples.size()));
  }
  if (rows.samples.empty()) throw InputError(file.string() + ": expected samples, found no rows");
  return rows;
}

std::optional<InertialRecording> FindInertial(const fs::path& path,
                                              DatasetFormat format,
                                              const InertialOptions& options) {
  std::error_code error;
  const bool folder = fs::is_directory(path, error);
  std::optional<InertialRecording> recording;
  std::optional<fs::path> sensors;
  if (format == DatasetFormat::kEuroc) {
    sensors = fs::exists(path / "mav0", error) ? path / "mav0" : path;
    const fs::path rows = *sensors / "imu0" / "data.csv";
    if (IsFileThere(rows)) recording = FromRows(rows);
  } else if (format == DatasetFormat::kBag || format == DatasetFormat::kMcap ||
             format == DatasetFormat::kRosbag2) {
    recording = FromTopics(path, format, options);
  } else if (folder && IsFileThere(path / "imu.csv")) {
    recording = FromRows(path / "imu.csv");
  }
  if (!recording) return std::nullopt;
  FindCalibration(options, folder ? path : path.parent_path(), sensors, *recording);
  return recording;
}

bool IsInertialAlone(const fs::path& path) {
  return (path.extension() == ".csv" && IsFileThere(path)) || IsImuFolder(path);
}

InertialRecording OpenInertialAlone(const fs::path& path, const InertialOptions& options) {
  const fs::path file = IsImuFolder(path) ? path / "data.csv" : path;
  InertialRecording recording = FromRows(file);
  const fs::path folder = file.parent_path();
  std::optional<fs::path> sensors;
  if (folder.filename() == "imu0") sensors = folder.parent_path();
  FindCalibration(options, folder, sensors, recording);
  return recording;
}

}  // namespace plumbline
