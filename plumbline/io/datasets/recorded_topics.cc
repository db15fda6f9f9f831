// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/recorded_topics.h"

#include "plumbline/base/printable.h"
#include "plumbline/io/datasets/raw_pixels.h"
#include "plumbline/io/datasets/rosbag2_files.h"
#include "plumbline/io/recordings/image_message.h"
#include "plumbline/io/recordings/recording_formats.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

// The last are those of `run --record`.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kPairNames = {
    {{"cam0", "cam1"}, {"left", "right"}, {"infra1", "infra2"}, {"camera/", "camera_right/"}}};

// Returns the encoding before compression: "16UC1" for "16UC1; compressedDepth png".
std::string_view UnpackedEncoding(std::string_view format) {
  return format.substr(0, format.find(';'));
}

TopicContents ContentsOf(const ImageMessage& image) {
  const std::string_view encoding = UnpackedEncoding(image.encoding);
  const auto contents = ContentsOfEncoding(encoding);
  if (contents != ImageContents::kDepth) {
    return contents || image.compressed ? TopicContents::kGray : TopicContents::kUnknown;
  }
  const bool either =
      Is16BitGray(encoding) && image.encoding.find("compressedDepth") == std::string::npos;
  return either ? TopicContents::kEither : TopicContents::kDepth;
}

// Returns true if the stamp 0 of the first image is a time, as in a simulation that begins at 0: no
// other image has it, and the next one follows soon. Otherwise 0 means a missing stamp.
bool BeginsAtZero(const std::vector<RecordedImage>& images) {
  constexpr std::int64_t kSoonNs = 60'000'000'000;
  if (images.size() < 2 || images[0].stamp_ns != 0 || images[1].stamp_ns > kSoonNs) return false;
  return std::none_of(images.begin() + 1, images.end(), [](const RecordedImage& image) {
    return image.stamp_ns == 0;
  });
}

// Returns true if a stamp is no time: negative, or ROS's "never" (2^32 - 1 seconds) or later.
bool IsNoTime(std::int64_t stamp_ns) { return stamp_ns < 0 || stamp_ns > kLatestStampNs; }

// Gives images without a stamp the time when they were recorded. Returns how many there are.
std::size_t TakeTimesOfRecording(std::vector<RecordedImage>& images) {
  const bool zero_is_time = BeginsAtZero(images);
  std::size_t count = 0;
  for (RecordedImage& image : images) {
    if (!IsNoTime(image.stamp_ns) && (image.stamp_ns != 0 || zero_is_time)) continue;
    image.stamp_ns = image.place.logged_ns;
    ++count;
  }
  return count;
}

// Collects the messages that pass.
class TopicCollector {
 public:
  // `whole`: true if a malformed message is an error; false if it is left out.
  TopicCollector(std::string path, bool whole) : path_(std::move(path)), whole_(whole) {}

  void Take(const Channel& channel,
            const StoredMessage& place,
            std::span<const std::uint8_t> bytes) {
    const std::optional<MessageForm> form = FormOf(channel);
    if (!form || form->kind == MessageKind::kInertial) return;
    if (form->kind == MessageKind::kCalibration) {
      if (calibrations_.contains(channel.topic)) return;
      const auto camera = ParseCalibration(*form, bytes);
      if (camera) calibrations_.emplace(channel.topic, *camera);
      if (!camera && whole_) Fail(channel);
      return;
    }
    const auto image = ParseImage(*form, bytes);
    RecordedTopic& topic = images_[channel.topic];
    topic.name = channel.topic;
    if (!image) {
      if (whole_) Fail(channel);
      if (++topic.broken == 1) first_broken_.emplace(channel.topic, channel);
      return;
    }
    if (topic.images.empty()) {
      topic.encoding = image->encoding;
      topic.frame = image->frame;
      topic.contents = ContentsOf(*image);
    }
    topic.images.push_back({image->stamp_ns, place});
  }

  // Orders the images by time; of several images of one stamp the first is kept.
  void MoveTo(RecordedTopics& topics) {
    topics.calibrations = std::move(calibrations_);
    for (auto& [name, topic] : images_) {
      auto& images = topic.images;
      if (images.empty()) {
        topics.notes.push_back(fmt::format("all messages of {} are damaged", Printable(name)));
        continue;
      }
      topic.without_stamp = TakeTimesOfRecording(images);
      for (const RecordedImage& image : images) {
        if (image.stamp_ns > kLatestStampNs) FailOfTime(name);
      }
      std::stable_sort(images.begin(), images.end(), [](const auto& a, const auto& b) {
        return a.stamp_ns < b.stamp_ns;
      });
      const auto same = [](const auto& a, const auto& b) { return a.stamp_ns == b.stamp_ns; };
      const auto end = std::unique(images.begin(), images.end(), same);
      topic.again = static_cast<std::size_t>(images.end() - end);
      images.erase(end, images.end());
      topics.images.push_back(std::move(topic));
    }
    if (topics.images.empty() && !first_broken_.empty()) Fail(first_broken_.begin()->second);
  }

 private:
  [[noreturn]] void Fail(const Channel& channel) const {
    throw InputError(fmt::format("{}: expected messages of {} on {}, found one that is none",
                                 path_,
                                 Printable(channel.type),
                                 Printable(channel.topic)));
  }

  [[noreturn]] void FailOfTime(const std::string& topic) const {
    throw InputError(
        fmt::format("{}: expected images with a time on {}, found one without a stamp "
                    "whose time of recording is none",
                    path_,
                    Printable(topic)));
  }

  std::string path_;
  bool whole_;
  std::map<std::string, Channel> first_broken_;  // channels of topics with broken messages
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

bool IsImage(const RecordedTopic& topic) { return topic.contents == TopicContents::kGray; }

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

std::vector<const RecordedTopic*> AllOf(const std::vector<RecordedTopic>& topics) {
  std::vector<const RecordedTopic*> all;
  for (const RecordedTopic& topic : topics) all.push_back(&topic);
  return all;
}

// Returns the topics with different images. Of images that were sent in several forms, one form is
// kept.
std::vector<const RecordedTopic*> WithoutCopies(const std::vector<RecordedTopic>& topics) {
  std::vector<const RecordedTopic*> found;
  for (const RecordedTopic& topic : topics) {
    if (topic.contents == TopicContents::kUnknown) continue;
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
                                   ListOfTopics(AllOf(topics.images))));
    }
    if (topic->contents == TopicContents::kUnknown) {
      throw InputError(fmt::format(
          "{}: {}: expected images as {}, found {}",
          topics.file->path().string(),
          Printable(name),
          EncodingsOf(ImageContents::kGray) + ", depth as " + EncodingsOf(ImageContents::kDepth),
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

// The names but those of inertial sensors (inertial_recording.h).
std::vector<std::string> WithoutInertial(const RecordedTopics& topics,
                                         const std::vector<std::string>& names) {
  std::vector<std::string> others;
  for (const std::string& name : names) {
    const auto& channels = topics.file->channels();
    const bool inertial = std::any_of(channels.begin(), channels.end(), [&](const Channel& c) {
      const auto form = FormOf(c);
      return c.topic == name && form && form->kind == MessageKind::kInertial;
    });
    if (!inertial) others.push_back(name);
  }
  return others;
}

void CheckThereAreImages(const RecordedTopics& topics) {
  if (!topics.images.empty()) return;
  std::set<std::string> types, without;
  constexpr std::size_t kMost = 20;
  for (const Channel& channel : topics.file->channels()) {
    const auto form = FormOf(channel);
    if (form && form->kind != MessageKind::kCalibration && form->kind != MessageKind::kInertial) {
      without.insert(Printable(channel.topic));
    } else if (types.size() < kMost) {
      types.insert(Printable(channel.type));
    }
  }
  std::string found = types.empty() ? "no messages" : fmt::format("{}", fmt::join(types, ", "));
  if (!without.empty()) {
    found = fmt::format("no message of the topics of images {}", fmt::join(without, ", "));
  }
  for (const std::string& note : topics.notes) found += "; " + note;
  throw InputError(
      fmt::format("{}: expected images (sensor_msgs/Image or CompressedImage, foxglove.RawImage or "
                  "CompressedImage), found {}",
                  topics.file->path().string(),
                  found));
}

using Topics = std::vector<const RecordedTopic*>;

bool NameSaysDepth(const std::string& topic) {
  std::string name = topic;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return name.find("depth") != std::string::npos;
}

bool IsEither(const RecordedTopic& topic) { return topic.contents == TopicContents::kEither; }

// Takes the topics that a user named, in the order left, right, depth.
ChosenTopics InNamedOrder(const RecordedTopics& topics,
                          const Topics& named,
                          std::optional<SensorKind> sensor) {
  const auto fail = [&] {
    throw InputError(
        fmt::format("{}: expected --topic to name images in the order left, right, depth, found {}",
                    topics.file->path().string(),
                    ListOfTopics(named)));
  };
  constexpr std::size_t kMost = 3;
  if (named.size() > kMost || named[0]->contents == TopicContents::kDepth) fail();
  ChosenTopics chosen;
  chosen.left = named[0];
  if (named.size() == 1) return chosen;
  bool depth = named[1]->contents == TopicContents::kDepth;
  if (named.size() == 2 && IsEither(*named[1])) {
    depth = !IsEither(*named[0]) || sensor == SensorKind::kRgbd ||
            (sensor != SensorKind::kStereo && NameSaysDepth(named[1]->name));
  }
  // Depth that is named before its image would pass for a left image of 16 bits.
  if (!depth && IsEither(*named[0]) != IsEither(*named[1])) fail();
  if (named.size() == kMost) {
    if (depth || named[2]->contents == TopicContents::kGray) fail();
    chosen.depth = named[2];
  }
  (depth ? chosen.depth : chosen.right) = named[1];
  return chosen;
}

// Takes a pair by its names, or one camera, and a topic of depth.
ChosenTopics FromAll(const RecordedTopics& topics, const Topics& all) {
  Topics gray, either, depth;
  for (const RecordedTopic* topic : all) {
    const bool is_depth = topic->contents == TopicContents::kDepth ||
                          (IsEither(*topic) && NameSaysDepth(topic->name));
    (is_depth ? depth : IsEither(*topic) ? either : gray).push_back(topic);
  }
  const auto pair = [](const RecordedTopic* left, const RecordedTopic* right) {
    return ArePair(BaseName(left->name), BaseName(right->name));
  };
  const auto order_pair = [&](Topics& two) {
    if (two.size() == 2 && pair(two[1], two[0])) std::swap(two[0], two[1]);
    return two.size() == 2 && pair(two[0], two[1]);
  };
  if (gray.empty() && order_pair(either)) std::swap(gray, either);
  if (gray.empty() && !either.empty()) {
    throw InputError(
        fmt::format("{}: expected an image beside what may be depth, found {}; --topic "
                    "NAME takes a topic of 16 bits for images",
                    topics.file->path().string(),
                    ListOfTopics(AllOf(topics.images))));
  }
  depth.insert(depth.end(), either.begin(), either.end());
  const bool two = order_pair(gray);
  if (depth.size() > 1 || !(gray.size() == 1 || two)) {
    throw InputError(
        fmt::format("{}: expected one camera or a pair (cam0 and cam1, left and right), with one "
                    "topic of depth or none, found {}; choose by --topic",
                    topics.file->path().string(),
                    ListOfTopics(AllOf(topics.images))));
  }
  ChosenTopics chosen;
  chosen.left = gray[0];
  if (two) chosen.right = gray[1];
  if (!depth.empty()) chosen.depth = depth[0];
  return chosen;
}

}  // namespace

std::string ListOfTopics(const std::vector<const RecordedTopic*>& topics) {
  constexpr std::size_t kMost = 20;
  std::vector<std::string> words;
  for (const RecordedTopic* topic : topics) {
    if (words.size() == kMost) {
      words.push_back(fmt::format("{} more", topics.size() - kMost));
      break;
    }
    words.push_back(fmt::format("{} ({}, {} images)",
                                Printable(topic->name),
                                Printable(topic->encoding),
                                topic->images.size()));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

RecordedTopics ReadTopics(const std::filesystem::path& path, DatasetFormat format) {
  const bool ros2 = format == DatasetFormat::kRosbag2;
  TopicCollector collector(path.string(), !ros2);
  const MessageSink sink =
      [&](const Channel& channel, const StoredMessage& place, std::span<const std::uint8_t> bytes) {
        if (!FormOf(channel)) return;
        const auto unpacked = UnpackedMessage(channel, bytes);
        if (!unpacked) {
          collector.Take(channel, place, bytes);
        } else if (*unpacked) {
          collector.Take(channel, place, **unpacked);
        } else {
          collector.Take(channel, place, {});  // no message: it counts as broken
        }
      };
  RecordedTopics topics;
  if (ros2) {
    const Rosbag2Files found = FindRosbag2Files(path);
    topics.file = ReadRosbag2(path, found.files, sink);
    topics.notes = found.notes;
  } else {
    topics.file = format == DatasetFormat::kBag ? ReadBag(path, sink) : ReadMcap(path, sink);
  }
  topics.notes.insert(topics.notes.end(), topics.file->notes().begin(), topics.file->notes().end());
  collector.MoveTo(topics);
  return topics;
}

ChosenTopics ChooseTopics(const RecordedTopics& topics,
                          const std::vector<std::string>& named,
                          std::optional<SensorKind> sensor) {
  CheckThereAreImages(topics);
  const std::vector<std::string> of_images = WithoutInertial(topics, named);
  if (!of_images.empty()) return InNamedOrder(topics, Named(topics, of_images), sensor);
  return FromAll(topics, WithoutCopies(topics.images));
}

const std::pair<const std::string, CalibrationMessage>* CalibrationFor(const RecordedTopics& topics,
                                                                       const RecordedTopic& image) {
  const std::string_view parent = ParentOf(BaseName(image.name));
  for (const auto& calibration : topics.calibrations) {
    if (ParentOf(calibration.first) == parent) return &calibration;
  }
  std::size_t cameras = 0, either = 0;
  for (const RecordedTopic* topic : WithoutCopies(topics.images)) {
    cameras += IsImage(*topic) ? 1 : 0;
    either += IsEither(*topic) ? 1 : 0;
  }
  if (cameras == 0) cameras = either;
  if (cameras != 1 || topics.calibrations.size() != 1) return nullptr;
  return &*topics.calibrations.begin();
}

bool IsRectifiedByName(const std::string& topic) {
  const std::string_view name = BaseName(topic);
  return name.substr(ParentOf(name).size()).find("rect") != std::string_view::npos;
}

}  // namespace plumbline
