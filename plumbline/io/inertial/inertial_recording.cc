// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/inertial/inertial_recording.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/base/units.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

bool IsFileThere(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool IsWithin(const InertialSample& first, const InertialSample& sample, double seconds) {
  return static_cast<double>(sample.stamp_ns - first.stamp_ns) <= seconds * kNsPerSecond;
}

// Tells how many samples of a source were left out, if any; refuses it where they are the most.
void JudgeUnusable(const UnusableSamples& unusable,
                   std::size_t usable,
                   const std::string& what,
                   InertialRecording& recording) {
  if (unusable.count == 0) return;
  const std::size_t all = unusable.count + usable;
  const std::string counts = fmt::format("{} of {} {} are no samples", unusable.count, all, what);
  const std::string first = unusable.first.empty() ? "" : "; the first: " + unusable.first;
  if (unusable.count > usable) {
    throw InputError(unusable.first.empty() ? recording.source + ": expected samples, but " + counts
                                            : fmt::format("{} ({})", unusable.first, counts));
  }
  recording.notes.push_back(counts + " and are left out" + first);
}

// The samples of a topic.
struct TopicSamples {
  std::vector<InertialSample> samples;
  bool has_rate = false, has_force = false;
  std::size_t broken = 0;
};
using AllTopics = std::map<std::string, TopicSamples>;

// Reads the topics of a recording, until one of them has samples of so many seconds.
AllTopics ReadAllTopics(const fs::path& path,
                        DatasetFormat format,
                        double seconds,
                        bool& complete) {
  AllTopics topics;
  ReadInertialMessages(path, format, [&](const InertialReading& reading) {
    TopicSamples& topic = topics[reading.topic];
    if (!reading.sample) {
      ++topic.broken;
      return true;
    }
    complete = topic.samples.empty() || IsWithin(topic.samples.front(), *reading.sample, seconds);
    if (!complete) return false;
    topic.has_rate = topic.has_rate || reading.has_rate;
    topic.has_force = topic.has_force || reading.has_force;
    topic.samples.push_back(*reading.sample);
    return true;
  });
  return topics;
}

// Keeps the topics that users named, if they named one of an inertial sensor.
void KeepNamed(const std::vector<std::string>& names, AllTopics& topics) {
  const auto named = [&](const auto& topic) {
    return std::find(names.begin(), names.end(), topic.first) != names.end();
  };
  if (std::none_of(topics.begin(), topics.end(), named)) return;
  std::erase_if(topics, [&](const auto& topic) { return !named(topic); });
}

using Topic = AllTopics::value_type;

const Topic* First(const AllTopics& topics, bool rate, bool force) {
  for (const Topic& topic : topics) {
    if (topic.second.has_rate == rate && topic.second.has_force == force) return &topic;
  }
  return nullptr;
}

void JudgeUnusable(const Topic& topic, InertialRecording& recording) {
  JudgeUnusable({topic.second.broken, ""},
                topic.second.samples.size(),
                "messages of " + Printable(topic.first),
                recording);
}

// Joins the samples of two topics. Returns true if the gyroscope's is the faster one.
bool TakeJoined(const Topic& gyroscope, const Topic& accelerometer, InertialRecording& recording) {
  const OrderedSamples rates = InOrderOfTime(gyroscope.second.samples);
  const OrderedSamples forces = InOrderOfTime(accelerometer.second.samples);
  recording.ordered.samples = JoinedSamples(rates.samples, forces.samples);
  recording.ordered.backward = rates.backward + forces.backward;
  recording.ordered.repeated = rates.repeated + forces.repeated;
  return MedianInterval(rates.samples) <= MedianInterval(forces.samples);
}

std::optional<InertialRecording> FromTopics(const fs::path& path,
                                            DatasetFormat format,
                                            const InertialOptions& options) {
  InertialRecording recording;
  AllTopics all = ReadAllTopics(path, format, options.seconds, recording.complete);
  KeepNamed(options.topics, all);
  const Topic* both = First(all, true, true);
  const Topic* gyroscope = both != nullptr ? both : First(all, true, false);
  const Topic* accelerometer = both != nullptr ? both : First(all, false, true);
  if (gyroscope == nullptr || accelerometer == nullptr) return std::nullopt;
  InertialTopics topics{gyroscope->first, accelerometer->first, true};
  const std::string name = Printable(gyroscope->first);
  if (both != nullptr) {
    recording.source = fmt::format("{} of {}", name, path.string());
    recording.ordered = InOrderOfTime(both->second.samples);
    if (all.size() > 1) {
      recording.notes.push_back(
          fmt::format("{} inertial sensors; {} is used, choose by --topic", all.size(), name));
    }
  } else {
    recording.source =
        fmt::format("{} and {} of {}", name, Printable(accelerometer->first), path.string());
    topics.gyroscope_leads = TakeJoined(*gyroscope, *accelerometer, recording);
    JudgeUnusable(*accelerometer, recording);
  }
  JudgeUnusable(*gyroscope, recording);
  recording.open = [=] { return OpenInertialTopics(path, format, topics); };
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
                     const std::optional<fs::path>& folder,
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
  if (const auto file = folder ? CameraFileIn(*folder) : std::nullopt) {
    AddCalibration(*file, body_from_left, false, recording);
  }
  if (sensors && IsFileThere(*sensors / "imu0" / "sensor.yaml")) {
    AddCalibration(*sensors / "imu0" / "sensor.yaml", body_from_left, false, recording);
  }
}

InertialRecording FromRows(const fs::path& file, double seconds) {
  InertialRecording recording;
  recording.source = file.string();
  recording.open = [file] { return OpenInertialRows(file); };
  const auto stream = recording.open();
  OrderedSamples& ordered = recording.ordered;
  TimeOrder order;
  while (const auto sample = stream->Next()) {
    if (!order.Takes(sample->stamp_ns)) continue;
    const bool first = ordered.samples.empty();
    recording.complete = first || IsWithin(ordered.samples.front(), *sample, seconds);
    if (!recording.complete) break;
    ordered.samples.push_back(*sample);
  }
  ordered.backward = order.backward();
  ordered.repeated = order.repeated();
  const std::size_t usable = ordered.samples.size() + ordered.backward + ordered.repeated;
  JudgeUnusable(stream->unusable(), usable, "rows", recording);
  if (usable == 0) throw InputError(file.string() + ": expected samples, found no rows");
  return recording;
}

// Samples that a caller has.
class GivenStream : public InertialStream {
 public:
  explicit GivenStream(std::shared_ptr<const std::vector<InertialSample>> samples)
      : samples_(std::move(samples)) {}

  std::optional<InertialSample> Next() override {
    return next_ < samples_->size() ? std::optional((*samples_)[next_++]) : std::nullopt;
  }

 private:
  std::shared_ptr<const std::vector<InertialSample>> samples_;
  std::size_t next_ = 0;
};

bool IsImuFolder(const fs::path& path) {
  return IsFileThere(path / "data.csv") && path.filename().string().starts_with("imu");
}

}  // namespace

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
    if (IsFileThere(rows)) recording = FromRows(rows, options.seconds);
  } else if (format == DatasetFormat::kBag || format == DatasetFormat::kMcap ||
             format == DatasetFormat::kRosbag2) {
    recording = FromTopics(path, format, options);
  } else if (folder && IsFileThere(path / "imu.csv")) {
    recording = FromRows(path / "imu.csv", options.seconds);
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
  InertialRecording recording = FromRows(file, options.seconds);
  const fs::path folder = file.parent_path();
  std::optional<fs::path> sensors;
  if (folder.filename() == "imu0") sensors = folder.parent_path();
  FindCalibration(options, folder, sensors, recording);
  return recording;
}

InertialRecording DescribeGivenInertial(std::vector<InertialSample> samples,
                                        const fs::path& path,
                                        const InertialOptions& options) {
  InertialRecording recording;
  recording.source = "imu";
  recording.ordered = InOrderOfTime(samples);
  const auto kept = std::make_shared<const std::vector<InertialSample>>(std::move(samples));
  recording.open = [kept] { return std::make_unique<GivenStream>(kept); };
  std::error_code error;
  FindCalibration(
      options, fs::is_directory(path, error) ? path : path.parent_path(), std::nullopt, recording);
  return recording;
}

InertialRecording DescribeLiveInertial(const std::string& source, const InertialOptions& options) {
  InertialRecording recording;
  recording.source = source;
  FindCalibration(options, std::nullopt, std::nullopt, recording);
  return recording;
}

}  // namespace plumbline
