// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/keyframe_images.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/camera_difference.h"
#include "plumbline/io/open_dataset.h"
#include "plumbline/io/trajectory_io.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace plumbline {
namespace {

// Returns the index of the frame of exactly this time.
std::optional<std::size_t> FrameAt(const Dataset& dataset, std::int64_t stamp_ns) {
  const std::vector<std::int64_t>& stamps = dataset.info().stamps_ns;
  const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp_ns);
  if (found == stamps.end() || *found != stamp_ns) return std::nullopt;
  return static_cast<std::size_t>(found - stamps.begin());
}

// Returns the differences between the rectified left camera of the data and the camera of the map.
// The baseline does not matter.
std::optional<std::string> LeftCameraDifference(const Rectifier& rectifier, const SavedMap& saved) {
  RectifiedCamera camera = rectifier.camera();
  camera.baseline = saved.camera.baseline;
  return CameraDifference({saved.camera, saved.rectified_from_left},
                          {camera, rectifier.rectified_left_from_left()});
}

}  // namespace

std::map<KeyFrameId, std::string> KeyFrameImageNames(const Map& map) {
  std::map<KeyFrameId, std::string> names;
  std::map<std::int64_t, int> seen;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const std::int64_t stamp = keyframe.frame.stamp_ns;
    const int count = ++seen[stamp];
    names[id] = count == 1 ? fmt::format("{}.png", stamp) : fmt::format("{}_{}.png", stamp, count);
  }
  return names;
}

KeyFrameImages::KeyFrameImages(const std::filesystem::path& path,
                               const DatasetOptions& options,
                               const SavedMap& saved) {
  dataset_ = OpenDataset(path, options);
  std::vector<SensorKind> sensors = dataset_->info().available;
  if (options.sensor) sensors = {*options.sensor};
  std::optional<std::string> difference;  // difference for the first sensor
  for (const SensorKind sensor : sensors) {
    DatasetOptions as_sensor = options;
    as_sensor.sensor = sensor;
    if (sensor != dataset_->sensor()) dataset_ = OpenDataset(path, as_sensor);
    rectifier_ = std::make_unique<Rectifier>(dataset_->calibration());
    const auto difference_now = LeftCameraDifference(*rectifier_, saved);
    if (!difference_now) {
      difference.reset();
      break;
    }
    if (!difference) difference = difference_now;
  }
  if (difference) {
    throw InputError(path.string() + ": expected the camera that the map was made with, found " +
                     "another one: " + *difference);
  }
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    if (FrameAt(*dataset_, keyframe.frame.stamp_ns)) continue;
    throw InputError(
        fmt::format("{}: expected a frame at {} s, where the map has keyframe {}, found none",
                    path.string(),
                    FormatStamp(keyframe.frame.stamp_ns),
                    id.value));
  }
}

GrayImage KeyFrameImages::Read(const KeyFrame& keyframe) const {
  const auto index = FrameAt(*dataset_, keyframe.frame.stamp_ns);
  PLUMBLINE_CHECK(index.has_value(), "a keyframe of another map");
  const Expected<SensorFrame, ImageFailure> read = dataset_->Read(*index);
  if (!read) throw InputError(read.error().path.string() + ": " + read.error().why);
  SensorFrame left;
  left.stamp_ns = read->stamp_ns;
  left.left = read->left;
  return rectifier_->Apply(std::move(left)).left;
}

}  // namespace plumbline
