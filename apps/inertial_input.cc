// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/inertial_input.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/base/units.h"
#include "plumbline/inertial/inertial_check.h"
#include "plumbline/inertial/rate_alignment.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"
#include "plumbline/io/trajectory_io.h"

#include "apps/command_inputs.h"
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

constexpr std::size_t kMostGiven = 60'000;  // samples for a frame
constexpr const char* kLeftOut = "the inertial sensor is left out: ";

// Throws InputError for a sensor whose place does not say how it is turned against the images.
void CheckPlace(Rotation rotation, const InertialRecording& recording) {
  CheckPlaceIsKnown(recording.calibration, recording.source);
  if (rotation != Rotation::kAuto && rotation != Rotation::kNone) {
    throw InputError(
        "--rotate: expected images as delivered, to which the place of an inertial "
        "sensor refers, found " +
        NameOf(rotation));
  }
}

// Returns what `find` finds, if --imu asks for a sensor. Throws InputError for one that cannot be
// used, or none, with a --imu FILE; with auto it is left out with a note.
template <class Find>
std::optional<InertialRecording> FindUsable(const InertialRequest& request,
                                            const std::string& source,
                                            const Find& find,
                                            InertialInput& input) {
  if (!request.used) return std::nullopt;
  InertialOptions options{request.file, request.camera, request.topics};
  options.seconds = TurningStretch::kSeconds;
  options.most = TurningStretch::kMostSamples;
  try {
    std::optional<InertialRecording> recording = find(options);
    if (recording) CheckPlace(request.rotation, *recording);
    if (!recording && request.required) {
      throw InputError(source + ": expected samples of an inertial sensor, found none");
    }
    if (!recording && request.asked) {
      input.notes.push_back("--imu auto: the data have no samples of an inertial sensor");
    }
    return recording;
  } catch (const InputError& error) {
    if (request.required) throw;
    input.notes.push_back(kLeftOut + std::string(error.what()));
    return std::nullopt;
  }
}

// Tells what is wrong with the samples, and takes the sensor unless its units are.
void UseIfSound(InertialRecording recording, InertialInput& input) {
  for (const std::string& note : recording.notes) {
    input.notes.push_back("inertial sensor: " + note);
  }
  const InertialCheck check = CheckInertial(recording.ordered, recording.calibration);
  const std::vector<std::string> faults = InertialFaults(check, recording.calibration);
  const bool wrong_units = check.rates_in_degrees;
  if (!faults.empty()) {
    input.notes.push_back(
        fmt::format("{}{}{}: {}",
                    wrong_units ? kLeftOut : "inertial sensor: ",
                    recording.source,
                    recording.complete ? "" : fmt::format(" (its first {:.0f} s)", check.seconds),
                    fmt::join(faults, "; ")));
  }
  if (wrong_units) return;
  if (check.saturated_rates > 0) {
    double& range = recording.calibration.range.gyroscope;
    range = std::min(range, check.largest_rate);
  }
  recording.ordered.samples = {};  // the run reads them again, as it needs them
  input.recording = std::make_shared<const InertialRecording>(std::move(recording));
}

}  // namespace

InertialRequest ReadInertialRequest(const CommandLine& line) {
  const std::string imu = line.Value("--imu").value_or(line.Has("--preset") ? "off" : "auto");
  const bool is_file = imu != "off" && imu != "auto";
  return {imu != "off",
          is_file,
          line.Has("--imu"),
          is_file ? std::optional(imu) : std::nullopt,
          line.Value("--camera"),
          line.Values("--topic"),
          ReadRotation(line)};
}

InertialInput OpenInertial(const InertialRequest& request, const Dataset& dataset) {
  InertialInput input;
  const DatasetInfo& info = dataset.info();
  const auto find = [&](const InertialOptions& options) {
    return FindInertial(info.path, info.format, options);
  };
  auto recording = FindUsable(request, info.path.string(), find, input);
  if (recording) UseIfSound(*std::move(recording), input);
  return input;
}

InertialInput OpenGivenInertial(const InertialRequest& request,
                                const Dataset& dataset,
                                std::vector<InertialSample> samples) {
  InertialInput input;
  const auto find = [&](const InertialOptions& options) {
    return std::optional(DescribeGivenInertial(
        std::move(samples), dataset.info().path, dataset.info().format, options));
  };
  auto recording = FindUsable(request, "imu", find, input);
  if (recording) UseIfSound(*std::move(recording), input);
  return input;
}

InertialInput OpenLiveInertial(const InertialRequest& request, const LiveSource& source) {
  InertialInput input;
  const std::string& name = source.info().name;
  const auto find = [&](const InertialOptions& options) {
    return source.HasInertial() ? std::optional(DescribeLiveInertial(name, options)) : std::nullopt;
  };
  auto recording = FindUsable(request, name, find, input);
  if (recording) {
    input.recording = std::make_shared<const InertialRecording>(*std::move(recording));
  }
  return input;
}

InertialFeed::InertialFeed(const InertialRecording* recording) : recording_(recording) {
  if (recording_ != nullptr && recording_->open) stream_ = recording_->open();
}

void InertialFeed::Add(std::span<const InertialSample> samples) {
  if (recording_ == nullptr) return;
  for (const InertialSample& sample : samples) {
    order_.Add(sample);
    TakeOrdered();
  }
}

void InertialFeed::TakeOrdered() {
  while (const auto sample = order_.Take()) {
    waiting_.push_back(*sample);
    if (waiting_.size() > kMostGiven) waiting_.pop_front();
  }
}

// Returns the next sample in order of time.
std::optional<InertialSample> InertialFeed::Next() {
  while (waiting_.empty() && stream_ != nullptr) {
    const auto sample = stream_->Next();
    unusable_ = stream_->unusable();
    sample ? order_.Add(*sample) : order_.End();
    if (!sample) stream_.reset();
    TakeOrdered();
  }
  return waiting_.empty() ? std::nullopt : std::optional(waiting_.front());
}

std::span<const InertialSample> InertialFeed::UpTo(std::int64_t stamp_ns) {
  constexpr double kMore = 0.02;  // seconds
  given_.clear();
  if (recording_ == nullptr) return {};
  last_ns_ = stamp_ns;
  const double offset = recording_->calibration.time_offset.value_or(0) + kMore;
  const auto last = stamp_ns + static_cast<std::int64_t>(offset * kNsPerSecond);
  for (auto sample = Next(); sample && sample->stamp_ns <= last; sample = Next()) {
    if (given_.size() == 2 * kMostGiven) given_.erase(given_.begin(), given_.end() - kMostGiven);
    given_.push_back(*sample);
    waiting_.pop_front();
  }
  if (given_.size() > kMostGiven) given_.erase(given_.begin(), given_.end() - kMostGiven);
  stretch_.Add(given_);
  return given_;
}

std::span<const InertialSample> InertialFeed::Telling() {
  UpTo(last_ns_ + kNsPerSecond / 2);
  return stretch_.best();
}

namespace {

// Why no turn of the camera could be compared with the gyroscope.
std::string WhyUnused(const RunResult& result,
                      const std::string& source,
                      std::span<const InertialSample> samples) {
  constexpr std::size_t kFewest = 4;  // a map's first frame, a motion, a turn, one to spare
  const auto main = result.MainMap();
  const std::size_t tracked = main ? result.CausalTrajectory(*main).size() : 0;
  if (tracked < kFewest) {
    return fmt::format("too few frames were tracked: {} of {}", tracked, result.frames.size());
  }
  const auto range = [](std::int64_t from_ns, std::int64_t to_ns) {
    return fmt::format("from {} to {} s", FormatStamp(from_ns), FormatStamp(to_ns));
  };
  return fmt::format("no turn between frames was covered by samples: {}; frames {}, samples {}",
                     source,
                     range(result.frames.front().stamp_ns, result.frames.back().stamp_ns),
                     samples.empty() ? "none until then"
                                     : range(samples.front().stamp_ns, samples.back().stamp_ns));
}

}  // namespace

std::vector<std::string> InertialNotes(const RunResult& result,
                                       const InertialRecording& recording,
                                       InertialFeed& feed,
                                       const UnusableSamples& unusable) {
  const std::span<const InertialSample> samples = feed.Telling();
  std::vector<std::string> notes;
  if (unusable.count > 0) {
    notes.push_back(fmt::format("inertial sensor: {} samples cannot be used and are left out{}{}",
                                unusable.count,
                                unusable.first.empty() ? "" : "; the first: ",
                                unusable.first));
  }
  if (!recording.open) {  // of a live source, whose samples were not known before
    OrderedSamples ordered = InOrderOfTime(samples);
    feed.CountInto(ordered);
    const InertialCheck check = CheckInertial(ordered, recording.calibration);
    const auto faults = InertialFaults(check, recording.calibration);
    if (!faults.empty()) {
      notes.push_back(
          fmt::format("inertial sensor: {}: {}", recording.source, fmt::join(faults, "; ")));
    }
  }
  const auto main = result.MainMap();
  const auto alignment = main ? AlignRates(result.FinalTrajectory(*main), samples) : std::nullopt;
  if (alignment) {
    for (const std::string& fault : AlignmentFaults(*alignment, recording.calibration)) {
      notes.push_back("inertial sensor: " + fault);
    }
  }
  if (result.inertial && result.inertial->turns == 0) {
    notes.push_back("inertial sensor: not used, as " +
                    WhyUnused(result, recording.source, samples));
  }
  if (result.inertial && result.inertial->contradicted > 0) {
    notes.push_back(
        fmt::format("inertial sensor: put aside for {} of {} turns, which the camera contradicted",
                    result.inertial->contradicted,
                    result.inertial->turns));
  }
  return notes;
}

}  // namespace plumbline
