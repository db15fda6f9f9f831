// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
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

// What the images of a topic can be. Those of 16 bits and one channel can be either.
enum class TopicContents { kUnknown, kGray, kDepth, kEither };

// The images that were sent under one name.
struct RecordedTopic {
  std::string name;
  std::string encoding;  // encoding of the first image: "mono8", "jpeg"
  std::string frame;     // coordinate frame of the first image; empty where it was not set
  TopicContents contents = TopicContents::kUnknown;  // kUnknown: the encoding is not known
  std::vector<RecordedImage> images;                 // in order of time, stamps strictly increasing
  // Images without a stamp, or with one that is no time, which have the time of recording.
  std::size_t without_stamp = 0;
  // Images that were left out because another one has the same stamp.
  std::size_t again = 0;
  // Messages that were left out because they are none of their type.
  std::size_t broken = 0;
};

// What a recording has that this program can use.
struct RecordedTopics {
  std::unique_ptr<Recording> file;
  std::vector<RecordedTopic> images;                       // ordered by name
  std::map<std::string, CalibrationMessage> calibrations;  // the first calibration of each topic
  std::vector<std::string> notes;  // one sentence for each thing that is missing
};

// Goes through a bag or an MCAP file once. Throws the errors of ReadBag, ReadMcap and ReadRosbag2,
// and InputError for a message that does not agree with its type; of ROS 2's bags only where a
// topic has no other ones.
RecordedTopics ReadTopics(const std::filesystem::path& path, DatasetFormat format);

// Returns "/cam0/image_raw (mono8, 250 images), ...", of at most 20 topics.
std::string ListOfTopics(const std::vector<const RecordedTopic*>& topics);

// The topics among `topics` that are the cameras of a run.
struct ChosenTopics {
  const RecordedTopic* left = nullptr;
  const RecordedTopic* right = nullptr;  // null where there is none
  const RecordedTopic* depth = nullptr;  // null where there is none
};

// Chooses the named topics, whose order is left, right, depth; or from what there is: one camera,
// or a pair by its names (cam0 and cam1, left and right, infra1 and infra2), and one topic of
// depth. Of an image that was sent in several forms the uncompressed one is taken.
//
// Images of 16 bits are grey where two of them are such a pair and nothing else is; and where they
// are named alone, or first. A second topic of them is then depth where `sensor` is RGB-D or its
// name says so. Otherwise they are depth. Throws InputError with a list of the topics where the
// choice is not clear or there is none.
ChosenTopics ChooseTopics(const RecordedTopics& topics,
                          const std::vector<std::string>& named,
                          std::optional<SensorKind> sensor);

// Returns the calibration that belongs to a topic: the one beside it (/cam0/image_raw,
// /cam0/camera_info), or the only one of a recording with one camera; nullptr where there is none.
const std::pair<const std::string, CalibrationMessage>* CalibrationFor(const RecordedTopics& topics,
                                                                       const RecordedTopic& image);

// Whether the name says that the images are rectified: image_rect, image_rect_color.
bool IsRectifiedByName(const std::string& topic);

}  // namespace plumbline
