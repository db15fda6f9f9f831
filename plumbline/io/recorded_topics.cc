// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recorded_topics.h"

#include "plumbline/base/printable.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/recording/mcap.h"
#include "plumbline/recording/parse_image_message.h"
#include "plumbline/recording/ros_bag.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

// The last are those of `run --record`.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kPairNames = {
    {{"cam0", "cam1"}, {"left", "right"}, {"infra1", "infra2"}, {"camera/", "camera_right/"}}};

// Returns what the image was before it was compressed: "16UC1" for "16UC1; compressedDepth png".
std::string_view UnpackedEncoding(std::string_view format) {
  return format.substr(0, format.find(';'));
}

std::optional<ImageContents> ContentsOf(const ImageMessage& image) {
  const auto contents = ContentsOfEncoding(UnpackedEncoding(image.encoding));
  if (!image.compressed) return contents;
  return contents == ImageContents::kDepth ? contents : ImageContents::kGray;
}

// Whether the stamp 0 of the first image is a time, as that of a simulation that begins at 0: no
// other image has it, and the next one comes soon after. Otherwise 0 means that there is no stamp.
bool BeginsAtZero(const std::vector<RecordedImage>& images) {
  constexpr std::int64_t kSoonNs = 60'000'000'000;
  if (images.size() < 2 || images[0].stamp_ns != 0 || images[1].stamp_ns > kSoonNs) return false;
  return std::none_of(images.begin() + 1, images.end(), [](const RecordedImage& image) {
    return image.stamp_ns == 0;
  });
}

// Gives images without a stamp the time when they were recorded. Returns how many there are.
std::size_t TakeTimesOfRecording(std::vector<RecordedImage>& images) {
  std::size_t count = 0;
  for (RecordedImage& image : images) {
    if (image.stamp_ns != 0) continue;
    image.stamp_ns = image.place.logged_ns;
    ++count;
  }
  return count;
}

// Collects the messages that pass.
class TopicCollector {
 public:
  explicit TopicCollector(std::string path) : path_(std::move(path)) {}

  void Take(const Channel& channel,
            const StoredMessage& place,
            std::span<const std::uint8_t> bytes) {
    const std::optional<MessageForm> form = FormOf(channel);
    if (!form) return;
    if (form->kind == MessageKind::kCalibration) {
      if (calibrations_.contains(channel.topic)) return;
      const auto camera = ParseCalibration(*form, bytes);
      if (!camera) Fail(channel);
      calibrations_.emplace(channel.topic, *camera);
      return;
    }
    const auto image = ParseImage(*form, bytes);
    if (!image) Fail(channel);
    RecordedTopic& topic = images_[channel.topic];
    if (topic.images.empty()) {
      topic.name = channel.topic;
      topic.encoding = image->encoding;
      topic.frame = image->frame;
      topic.contents = ContentsOf(*image);
    }
    const std::int64_t stamp_ns = image->stamp_ns;
    const std::int64_t checked_ns = stamp_ns == 0 ? place.logged_ns : stamp_ns;
    if (checked_ns < 0 || checked_ns > kLatestStampNs) Fail(channel);
    topic.images.push_back({stamp_ns, place});
  }

  // Orders the images by time; of several images of one stamp the first is kept.
  void MoveTo(RecordedTopics& topics) {
    topics.calibrations = std::move(calibrations_);
    for (auto& [name, topic] : images_) {
      auto& images = topic.images;
      if (!BeginsAtZero(images)) topic.without_stamp = TakeTimesOfRecording(images);
      std::stable_sort(images.begin(), images.end(), [](const auto& a, const auto& b) {
        return a.stamp_ns < b.stamp_ns;
      });
      const auto same = [](const auto& a, const auto& b) { return a.stamp_ns == b.stamp_ns; };
      const auto end = std::unique(images.begin(), images.end(), same);
      topic.again = static_cast<std::size_t>(images.end() - end);
      images.erase(end, images.end());
      topics.images.push_back(std::move(topic));
    }
  }

 private:
  [[noreturn]] void Fail(const Channel& channel) const {
    throw InputError(fmt::format("{}: expected messages of {} on {}, found one that is none",
                                 path_,
                                 Printable(channel.type),
                                 Printable(channel.topic)));
  }

  std::string path_;
  std::map<std::string, RecordedTopic> images_;
  std::map<std::string, CalibrationMessage> calibrations_;
};

// Returns the name without the ending that image_transport adds.
std::string_view BaseName(std::string_view topic) {
  for (const std::string_view transport : {"/compressed", "/compressedDepth"}) {
    if (topic.ends_with(transport)) return topic.substr(0, topic.size() - transport.size());
  }
  return topic;
}

std::string_view ParentOf(std::string_view topic) {
  return topic.substr(0, std::min(topic.rfind('/'), topic.size()));
}

bool ArePair(std::string_view left, std::string_view right) {
  for (const auto& [left_word, right_word] : kPairNames) {
    for (std::size_t at = left.find(left_word); at != std::string_view::npos;
         at = left.find(left_word, at + 1)) {
      std::string other(left);
      other.replace(at, left_word.size(), right_word);
      if (other == right) return true;
    }
  }
  return false;
}

// Returns "/cam0/image_raw (mono8, 250 images), ...".
std::string ListOf(const std::vector<RecordedTopic>& topics) {
  constexpr std::size_t kMost = 20;
  std::vector<std::string> words;
  for (const RecordedTopic& topic : topics) {
    if (words.size() == kMost) {
      words.push_back(fmt::format("{} more", topics.size() - kMost));
      break;
    }
    words.push_back(fmt::format("{} ({}, {} images)",
                                Printable(topic.name),
                                Printable(topic.encoding),
                                topic.images.size()));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

// Returns the topics with different images. Of images that were sent in several forms, one form is
// kept.
std::vector<const RecordedTopic*> WithoutCopies(const std::vector<RecordedTopic>& topics) {
  std::vector<const RecordedTopic*> found;
  for (const RecordedTopic& topic : topics) {
    if (!topic.contents) continue;
    const bool copy = std::any_of(found.begin(), found.end(), [&](const RecordedTopic* other) {
      return BaseName(other->name) == BaseName(topic.name);
    });
    if (!copy) found.push_back(&topic);
  }
  return found;
}

std::vector<const RecordedTopic*> Named(const RecordedTopics& topics,
                                        const std::vector<std::string>& names) {
  std::vector<const RecordedTopic*> found;
  for (const std::string& name : names) {
    const auto topic = std::find_if(topics.images.begin(),
                                    topics.images.end(),
                                    [&](const RecordedTopic& t) { return t.name == name; });
    if (topic == topics.images.end()) {
      throw InputError(fmt::format("{}: expected images on topic {}, found none; topics: {}",
                                   topics.file->path().string(),
                                   InQuotes(name),
                                   ListOf(topics.images)));
    }
    if (!topic->contents) {
      throw InputError(fmt::format("{}: {}: expected images as {}, found {}",
                                   topics.file->path().string(),
                                   Printable(name),
                                   KnownEncodings(),
                                   InQuotes(topic->encoding)));
    }
    if (std::find(found.begin(), found.end(), &*topic) != found.end()) {
      throw InputError(fmt::format("{}: expected each topic once, found {} twice",
                                   topics.file->path().string(),
                                   InQuotes(name)));
    }
    found.push_back(&*topic);
  }
  return found;
}

void CheckThereAreImages(const RecordedTopics& topics) {
  if (!topics.images.empty()) return;
  std::vector<std::string> types;
  constexpr std::size_t kMost = 20;
  for (const Channel& channel : topics.file->channels()) {
    if (types.size() < kMost) types.push_back(Printable(channel.type));
  }
  std::sort(types.begin(), types.end());
  types.erase(std::unique(types.begin(), types.end()), types.end());
  throw InputError(
      fmt::format("{}: expected images (sensor_msgs/Image or CompressedImage, foxglove.RawImage or "
                  "CompressedImage), found {}",
                  topics.file->path().string(),
                  types.empty() ? "no messages" : fmt::format("{}", fmt::join(types, ", "))));
}

}  // namespace

RecordedTopics ReadTopics(const std::filesystem::path& path, DatasetFormat format) {
  TopicCollector collector(path.string());
  const MessageSink sink =
      [&](const Channel& channel, const StoredMessage& place, std::span<const std::uint8_t> bytes) {
        collector.Take(channel, place, bytes);
      };
  RecordedTopics topics;
  topics.file = format == DatasetFormat::kBag ? ReadBag(path, sink) : ReadMcap(path, sink);
  collector.MoveTo(topics);
  return topics;
}

ChosenTopics ChooseTopics(const RecordedTopics& topics, const std::vector<std::string>& named) {
  CheckThereAreImages(topics);
  const std::vector<const RecordedTopic*> usable =
      named.empty() ? WithoutCopies(topics.images) : Named(topics, named);
  ChosenTopics chosen;
  std::vector<const RecordedTopic*> gray;
  std::size_t depths = 0;
  for (const RecordedTopic* topic : usable) {
    if (topic->contents == ImageContents::kGray) {
      gray.push_back(topic);
    } else {
      ++depths;
      chosen.depth = topic;
    }
  }
  const auto pair = [&](std::size_t left, std::size_t right) {
    return ArePair(BaseName(gray[left]->name), BaseName(gray[right]->name));
  };
  const bool two = gray.size() == 2;
  if (two && pair(1, 0)) std::swap(gray[0], gray[1]);
  if (depths > 1 || !(gray.size() == 1 || (two && (pair(0, 1) || !named.empty())))) {
    throw InputError(
        fmt::format("{}: expected {}one camera or a pair (cam0 and cam1, left and right), with one "
                    "topic of depth or none, found {}; choose by --topic",
                    topics.file->path().string(),
                    named.empty() ? "" : "--topic to name ",
                    ListOf(topics.images)));
  }
  chosen.left = gray[0];
  if (two) chosen.right = gray[1];
  return chosen;
}

const std::pair<const std::string, CalibrationMessage>* CalibrationFor(const RecordedTopics& topics,
                                                                       const RecordedTopic& image) {
  const std::string_view parent = ParentOf(BaseName(image.name));
  for (const auto& calibration : topics.calibrations) {
    if (ParentOf(calibration.first) == parent) return &calibration;
  }
  std::size_t cameras = 0;
  for (const RecordedTopic* topic : WithoutCopies(topics.images)) {
    cameras += topic->contents == ImageContents::kGray ? 1 : 0;
  }
  if (cameras != 1 || topics.calibrations.size() != 1) return nullptr;
  return &*topics.calibrations.begin();
}

bool IsRectifiedByName(const std::string& topic) {
  const std::string_view name = BaseName(topic);
  return name.substr(ParentOf(name).size()).find("rect") != std::string_view::npos;
}

}  // namespace plumbline
