// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "inertial_queue.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/units.h"
#include "plumbline/inertial/inertial_samples.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace plumbline::ros_node {
namespace {

constexpr std::int64_t kMoreNs = 20'000'000;  // beyond a frame's stamp, as of a recording
constexpr std::int64_t kPatienceNs = 100'000'000;
constexpr std::size_t kMostSamples = 20'000;

std::optional<InertialCalibration> ToldBy(const std::string& camera) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(camera, error)) return std::nullopt;
  const std::string text = ReadInputFile(camera, kLargestSettings);
  if (IsColmapCameras(text)) return std::nullopt;
  return ParseInertialCalibration(YamlSection::Parse(text, camera));
}

}  // namespace

std::optional<InertialCalibration> FindInertialCalibration(const std::string& imu,
                                                           const std::string& camera) {
  if (imu == "off") return std::nullopt;
  const bool wanted = imu != "auto";
  InertialCalibration found;
  if (wanted) found = ReadInertialCalibration(imu);
  if (const auto more = ToldBy(camera)) found = Completed(found, *more);
  if (!wanted && !found.imu_from_left) return std::nullopt;
  CheckPlaceIsKnown(found, imu);
  return found;
}

std::optional<InertialSample> SampleOf(const InertialMessage& message) {
  if (message.stamp_ns <= 0 || !message.has_rate) return std::nullopt;
  const InertialSample sample{message.stamp_ns,
                              Eigen::Map<const Eigen::Vector3d>(message.angular_rate.data()),
                              Eigen::Map<const Eigen::Vector3d>(message.specific_force.data())};
  return IsPlausible(sample) ? std::optional(sample) : std::nullopt;
}

InertialQueue::InertialQueue(double time_offset, bool patient)
    : offset_ns_(static_cast<std::int64_t>(time_offset * kNsPerSecond)),
      awaited_ns_(offset_ns_ + (patient ? kMoreNs : 0)) {}

void InertialQueue::Add(const InertialSample& sample) {
  if (newest_ns_ && sample.stamp_ns <= *newest_ns_) {
    if (*newest_ns_ - sample.stamp_ns <= kNsPerSecond) return;
    samples_.clear();
  }
  newest_ns_ = sample.stamp_ns;
  samples_.push_back(sample);
  if (samples_.size() > kMostSamples) samples_.pop_front();
}

bool InertialQueue::MustWait(std::int64_t frame_ns, std::int64_t newest_frame_ns) const {
  if (!newest_ns_ || newest_frame_ns - frame_ns > kPatienceNs) return false;
  return *newest_ns_ < frame_ns + awaited_ns_ && frame_ns + offset_ns_ - *newest_ns_ < kNsPerSecond;
}

std::vector<InertialSample> InertialQueue::TakeUpTo(std::int64_t frame_ns) {
  const auto end = std::find_if(samples_.begin(), samples_.end(), [&](const InertialSample& s) {
    return s.stamp_ns > frame_ns + offset_ns_ + kMoreNs;
  });
  std::vector<InertialSample> taken(samples_.begin(), end);
  samples_.erase(samples_.begin(), end);
  return taken;
}

}  // namespace plumbline::ros_node
