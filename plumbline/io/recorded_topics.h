// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
#include "plumbline/io/raw_pixels.h"
#include "plumbline/recording/image_message.h"
#include "plumbline/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// An image of a topic.
struct RecordedImage {
  std::int64_t stamp_ns = 0;
  StoredMessage place;
};

// The images that were sent under one name.
struct RecordedTopic {
  std::string name;
  std::string encoding;                   // of the first image: "mono8", "jpeg"
  std::optional<ImageContents> contents;  // nullopt where the encoding is not known
  std::vector<RecordedImage> images;      // by time, stamps strictly increasing
  std::size_t without_stamp = 0;          // have the time when they were recorded
  std::size_t again = 0;                  // of the stamp of another one, left out
};

// What a recording has for this program.
struct RecordedTopics {
  std::unique_ptr<Recording> file;
  std::vector<RecordedTopic> images;                       // by name
  std::map<std::string, CalibrationMessage> calibrations;  // the first of each topic
};

// Goes through a bag or an MCAP file once. Errors as of ReadBag and ReadMcap; also InputError for
// a message that is not what its type says.
RecordedTopics ReadTopics(const std::filesystem::path& path, DatasetFormat format);

// The topics that are the cameras of a run; of `topics`.
struct ChosenTopics {
  const RecordedTopic* left = nullptr;
  const RecordedTopic* right = nullptr;  // null: there is none
  const RecordedTopic* depth = nullptr;  // null: there is none
};

// Those named, or what there is: one camera, or a pair by its names (cam0 and cam1, left and right,
// infra1 and infra2), and one topic of depth. Of an image that was sent in several forms the one
// that is not packed. InputError that lists the topics where that is not clear or there is none.
ChosenTopics ChooseTopics(const RecordedTopics& topics, const std::vector<std::string>& named);

// The calibration that belongs to a topic: the one beside it (/cam0/image_raw, /cam0/camera_info),
// or the only one of a recording with one camera. nullptr where there is none.
const std::pair<const std::string, CalibrationMessage>* CalibrationFor(const RecordedTopics& topics,
                                                                       const RecordedTopic& image);

// Whether the name says that the images are rectified: image_rect, image_rect_color.
bool IsRectifiedByName(const std::string& topic);

}  // namespace plumbline
