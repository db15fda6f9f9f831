// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/recordings/image_message.h"
#include "plumbline/io/recordings/recording.h"

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

// Possible contents of the images of a topic. Those of 16 bits and one channel can be either.
enum class TopicContents { kUnknown, kGray, kDepth, kEither };

// The images of a topic.
struct RecordedTopic {
  std::string name;
  std::string encoding;  // encoding of the first image: "mono8", "jpeg"
  std::string frame;     // coordinate frame of the first image; empty if not set
  TopicContents contents = TopicContents::kUnknown;  // kUnknown: unknown encoding
  std::vector<RecordedImage> images;                 // in order of time, stamps strictly increasing
  // Images with a missing or invalid stamp, which have the time of recording.
  std::size_t without_stamp = 0;
  // Images left out because of a repeated stamp.
  std::size_t again = 0;
  // Messages left out because they cannot be parsed.
  std::size_t broken = 0;
};

// The usable contents of a recording.
struct RecordedTopics {
  std::unique_ptr<Recording> file;
  std::vector<RecordedTopic> images;                       // ordered by name
  std::map<std::string, CalibrationMessage> calibrations;  // the first calibration of each topic
  std::vector<std::string> notes;                          // one sentence for each missing part
};

// Scans a bag or an MCAP file once. Throws the errors of ReadBag, ReadMcap and ReadRosbag2, and
// InputError for a message inconsistent with its type; in ROS 2's bags only if a topic has no other
// ones.
RecordedTopics ReadTopics(const std::filesystem::path& path, DatasetFormat format);

// Returns "/cam0/image_raw (mono8, 250 images), ...", of at most 20 topics.
std::string ListOfTopics(const std::vector<const RecordedTopic*>& topics);

// The topics among `topics` of the cameras of a run.
struct ChosenTopics {
  const RecordedTopic* left = nullptr;
  const RecordedTopic* right = nullptr;  // null if there is none
  const RecordedTopic* depth = nullptr;  // null if there is none
};

// Selects the named topics, in the order left, right, depth, without those of inertial sensors; or
// by default one camera, or a pair by its names (cam0 and cam1, left and right, infra1 and infra2),
// and one topic of depth. Of an image sent in several forms the uncompressed one is taken.
//
// Images of 16 bits are grey if two topics of them are the only pair by name, and if they are named
// alone, or first. A second topic of them is then depth if `sensor` is RGB-D or its name says so.
// Otherwise they are depth. Throws InputError with a list of the topics if the choice is ambiguous
// or there is none.
ChosenTopics ChooseTopics(const RecordedTopics& topics,
                          const std::vector<std::string>& named,
                          std::optional<SensorKind> sensor);

// Returns the calibration of a topic: the one beside it (/cam0/image_raw, /cam0/camera_info), or
// the only one of a recording with one camera; nullptr if there is none.
const std::pair<const std::string, CalibrationMessage>* CalibrationFor(const RecordedTopics& topics,
                                                                       const RecordedTopic& image);

// Returns true if the name is one of rectified images: image_rect, image_rect_color.
bool IsRectifiedByName(const std::string& topic);

}  // namespace plumbline
