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

// The first samples of a source, in order of time.
class FirstSamples {
 public:
  // Returns false once there are as many as the options want.
  bool Add(const InertialSample& sample, const InertialOptions& options) {
    order_.Add(sample);
    return Take(options);
  }
  // After the last sample.
  bool End(const InertialOptions& options) {
    order_.End();
    return Take(options);
  }
  OrderedSamples Ordered() && {
    order_.CountInto(ordered_);
    return std::move(ordered_);
  }

 private:
  bool Take(const InertialOptions& options) {
    std::vector<InertialSample>& taken = ordered_.samples;
    while (const auto next = order_.Take()) {
      if (!taken.empty()) {
        const auto ns = static_cast<double>(next->stamp_ns - taken.front().stamp_ns);
        if (ns > options.seconds * kNsPerSecond || taken.size() >= options.most) return false;
      }
      taken.push_back(*next);
    }
    return true;
  }

  TimeOrder order_;
  OrderedSamples ordered_;
};

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
  FirstSamples first;
  OrderedSamples ordered;  // when all are read
  bool has_rate = false, has_force = false;
  std::size_t usable = 0, broken = 0;
};
using AllTopics = std::map<std::string, TopicSamples>;

// Reads the topics of a recording, until one of them has as many samples as the options want.
AllTopics ReadAllTopics(const fs::path& path,
                        DatasetFormat format,
                        const InertialOptions& options,
                        bool& complete) {
  AllTopics topics;
  ReadInertialMessages(path, format, [&](const InertialReading& reading) {
    TopicSamples& topic = topics[reading.topic];
    if (!reading.sample) {
      ++topic.broken;
      return true;
    }
    ++topic.usable;
    topic.has_rate = topic.has_rate || reading.has_rate;
    topic.has_force = topic.has_force || reading.has_force;
    complete = topic.first.Add(*reading.sample, options);
    return complete;
  });
  for (auto& [name, topic] : topics) {
    if (complete) topic.first.End(options);
    topic.ordered = std::move(topic.first).Ordered();
  }
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
                topic.second.usable,
                "messages of " + Printable(topic.first),
                recording);
}

// Throws InputError for a topic that has no samples because its messages cannot be used.
void RefuseBroken(const AllTopics& topics, const fs::path& path) {
  for (const Topic& topic : topics) {
    InertialRecording broken;
    broken.source = fmt::format("{} of {}", Printable(topic.first), path.string());
    JudgeUnusable(topic, broken);
  }
}

// Joins the samples of two topics. Returns true if the gyroscope's is the faster one.
bool TakeJoined(const Topic& gyroscope, const Topic& accelerometer, InertialRecording& recording) {
  const OrderedSamples& rates = gyroscope.second.ordered;
  const OrderedSamples& forces = accelerometer.second.ordered;
  recording.ordered.samples = JoinedSamples(rates.samples, forces.samples);
  recording.ordered.backward = rates.backward + forces.backward;
  recording.ordered.repeated = rates.repeated + forces.repeated;
  recording.ordered.ahead = rates.ahead + forces.ahead;
  return MedianInterval(rates.samples) <= MedianInterval(forces.samples);
}

std::optional<InertialRecording> FromTopics(const fs::path& path,
                                            DatasetFormat format,
                                            const InertialOptions& options) {
  InertialRecording recording;
  AllTopics all = ReadAllTopics(path, format, options, recording.complete);
  KeepNamed(options.topics, all);
  const Topic* both = First(all, true, true);
  const Topic* gyroscope = both != nullptr ? both : First(all, true, false);
  const Topic* accelerometer = both != nullptr ? both : First(all, false, true);
  if (gyroscope == nullptr || accelerometer == nullptr) {
    RefuseBroken(all, path);
    return std::nullopt;
  }
  InertialTopics topics{gyroscope->first, accelerometer->first, true};
  const std::string name = Printable(gyroscope->first);
  if (both != nullptr) {
    recording.source = fmt::format("{} of {}", name, path.string());
    recording.ordered = both->second.ordered;
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

InertialRecording FromRows(const fs::path& file, const InertialOptions& options) {
  InertialRecording recording;
  recording.source = file.string();
  recording.open = [file] { return OpenInertialRows(file); };
  const auto stream = recording.open();
  FirstSamples first;
  std::size_t usable = 0;
  std::optional<InertialSample> sample;
  while (recording.complete && (sample = stream->Next())) {
    ++usable;
    recording.complete = first.Add(*sample, options);
  }
  if (recording.complete) recording.complete = first.End(options);
  recording.ordered = std::move(first).Ordered();
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

// The folder with imu0 and cam0 of a sequence of EuRoC's form.
std::optional<fs::path> SensorsOf(const fs::path& path, DatasetFormat format) {
  if (format != DatasetFormat::kEuroc) return std::nullopt;
  std::error_code error;
  return fs::exists(path / "mav0", error) ? path / "mav0" : path;
}

// The folder where a camera file of a sequence would be.
fs::path FolderOf(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? path : path.parent_path();
}

}  // namespace

std::optional<InertialRecording> FindInertial(const fs::path& path,
                                              DatasetFormat format,
                                              const InertialOptions& options) {
  const std::optional<fs::path> sensors = SensorsOf(path, format);
  std::optional<InertialRecording> recording;
  if (format == DatasetFormat::kBag || format == DatasetFormat::kMcap ||
      format == DatasetFormat::kRosbag2) {
    recording = FromTopics(path, format, options);
  } else {
    const fs::path rows = sensors ? *sensors / "imu0" / "data.csv" : path / "imu.csv";
    if (IsTaken(rows)) recording = FromRows(rows, options);
  }
  if (!recording) return std::nullopt;
  FindCalibration(options, FolderOf(path), sensors, *recording);
  return recording;
}

bool IsInertialAlone(const fs::path& path) {
  return (path.extension() == ".csv" && IsFileThere(path)) || IsImuFolder(path);
}

InertialRecording OpenInertialAlone(const fs::path& path, const InertialOptions& options) {
  const fs::path file = IsImuFolder(path) ? path / "data.csv" : path;
  InertialRecording recording = FromRows(file, options);
  const fs::path folder = file.parent_path();
  std::optional<fs::path> sensors;
  if (folder.filename() == "imu0") sensors = folder.parent_path();
  FindCalibration(options, folder, sensors, recording);
  return recording;
}

InertialRecording DescribeGivenInertial(std::vector<InertialSample> samples,
                                        const fs::path& path,
                                        DatasetFormat format,
                                        const InertialOptions& options) {
  InertialRecording recording;
  recording.source = "imu";
  recording.ordered = InOrderOfTime(samples);
  const auto kept = std::make_shared<const std::vector<InertialSample>>(std::move(samples));
  recording.open = [kept] { return std::make_unique<GivenStream>(kept); };
  FindCalibration(options, FolderOf(path), SensorsOf(path, format), recording);
  return recording;
}

InertialRecording DescribeLiveInertial(const std::string& source, const InertialOptions& options) {
  InertialRecording recording;
  recording.source = source;
  FindCalibration(options, std::nullopt, std::nullopt, recording);
  return recording;
}

}  // namespace plumbline
