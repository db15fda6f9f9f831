// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/inertial_input.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/base/units.h"
#include "plumbline/inertial/inertial_check.h"
#include "plumbline/inertial/rate_alignment.h"

#include "apps/command_inputs.h"
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

constexpr const char* kLeftOut = "the inertial sensor is left out: ";

// Throws InputError for a sensor that cannot be used, or for a --imu FILE without one.
std::optional<InertialRecording> FindUsable(const CommandLine& line,
                                            const Dataset& dataset,
                                            const std::optional<std::string>& file) {
  const DatasetInfo& info = dataset.info();
  InertialOptions options{file, line.Value("--camera"), line.Values("--topic")};
  auto recording = FindInertial(info.path, info.format, options);
  if (!recording) {
    if (!file) return std::nullopt;
    throw InputError(info.path.string() + ": expected samples of an inertial sensor, found none");
  }
  if (!recording->calibration.imu_from_left) {
    throw InputError(recording->source +
                     ": expected the place of the sensor at the camera (imu_from_left of a camera "
                     "file, T_cam_imu of Kalibr), found none");
  }
  const Rotation rotation = ReadRotation(line);
  if (rotation != Rotation::kAuto && rotation != Rotation::kNone) {
    throw InputError(
        "--rotate: expected images as delivered, to which the place of an inertial "
        "sensor refers, found " +
        NameOf(rotation));
  }
  return recording;
}

}  // namespace

InertialInput OpenInertial(const CommandLine& line, const Dataset& dataset) {
  InertialInput input;
  const std::string imu = line.Value("--imu").value_or("off");
  if (imu == "off") return input;
  const bool wanted = imu != "auto";
  std::optional<InertialRecording> recording;
  try {
    recording = FindUsable(line, dataset, wanted ? std::optional(imu) : std::nullopt);
  } catch (const InputError& error) {
    if (wanted) throw;
    input.notes.push_back(kLeftOut + std::string(error.what()));
  }
  if (!recording) {
    if (input.notes.empty()) {
      input.notes.push_back("--imu auto: the data have no samples of an inertial sensor");
    }
    return input;
  }
  for (const std::string& note : recording->notes) {
    input.notes.push_back("inertial sensor: " + note);
  }
  const InertialCheck check = CheckInertial(recording->ordered, recording->calibration);
  const std::vector<std::string> faults = InertialFaults(check, recording->calibration);
  const bool wrong_units = check.rates_in_degrees;
  if (!faults.empty()) {
    input.notes.push_back(fmt::format("{}{}: {}",
                                      wrong_units ? kLeftOut : "inertial sensor: ",
                                      recording->source,
                                      fmt::join(faults, "; ")));
  }
  if (wrong_units) return input;
  if (check.saturated_rates > 0) {
    double& range = recording->calibration.range.gyroscope;
    range = std::min(range, check.largest_rate);
  }
  input.recording = std::make_shared<const InertialRecording>(*std::move(recording));
  return input;
}

std::span<const InertialSample> InertialFeed::UpTo(std::int64_t stamp_ns) {
  constexpr double kMore = 0.02;  // seconds
  if (recording_ == nullptr) return {};
  const double offset = recording_->calibration.time_offset.value_or(0) + kMore;
  const auto last = stamp_ns + static_cast<std::int64_t>(offset * kNsPerSecond);
  const std::vector<InertialSample>& samples = recording_->ordered.samples;
  const std::size_t first = next_;
  while (next_ < samples.size() && samples[next_].stamp_ns <= last) ++next_;
  return std::span(samples).subspan(first, next_ - first);
}

std::vector<std::string> InertialNotes(const RunResult& result,
                                       const InertialRecording& recording) {
  std::vector<std::string> notes;
  const auto main = result.MainMap();
  const auto alignment =
      main ? AlignRates(result.FinalTrajectory(*main), recording.ordered.samples) : std::nullopt;
  if (alignment) {
    for (const std::string& fault : AlignmentFaults(*alignment, recording.calibration)) {
      notes.push_back("inertial sensor: " + fault);
    }
  }
  if (result.inertial && result.inertial->turns == 0) {
    notes.push_back(
        "inertial sensor: not used, as no turn between frames was covered by samples: " +
        recording.source);
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
