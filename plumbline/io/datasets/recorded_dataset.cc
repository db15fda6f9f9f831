// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/ground_truth.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/datasets/message_pixels.h"
#include "plumbline/io/datasets/recorded_calibration.h"
#include "plumbline/io/datasets/recorded_topics.h"
#include "plumbline/io/datasets/stamp_order.h"
#include "plumbline/io/recordings/image_message.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxPairDelayNs = 5'000'000;
constexpr std::int64_t kMaxDepthDelayNs = 20'000'000;
// Units per metre of depth in 16 bits, as ROS has it (REP 118).
constexpr double kMillimetres = 1000;

// The messages of a frame.
struct FrameMessages {
  StoredMessage left;
  std::optional<StoredMessage> right, depth;
  std::optional<StoredMessage> left_mask = std::nullopt, right_mask = std::nullopt;
};

// Calls `decode` with the image in a message of a file.
template <class Image, class Decode>
Expected<Image, ImageFailure> ReadMessage(const Recording& file,
                                          const StoredMessage& place,
                                          const Decode& decode) {
  const Channel& channel = file.channels()[place.channel];
  const auto bytes = file.Message(place);
  if (!bytes) return ImageFailure{file.path(), Printable(channel.topic) + ": " + bytes.error()};
  const auto message = ParseImage(*FormOf(channel), *bytes);
  if (!message) {
    return ImageFailure{file.path(), Printable(channel.topic) + ": the file has changed"};
  }
  Expected<Image, ImageFailure> image = decode(*message);
  if (image) return image;
  ImageFailure failure = image.error();
  if (failure.other_size) failure.path += ": " + Printable(channel.topic);
  failure.why = Printable(channel.topic) + ": " + failure.why;
  return failure;
}

Expected<GrayImage, ImageFailure> ReadMaskMessage(const Recording& file,
                                                  const StoredMessage& place,
                                                  std::optional<ImageSize> size) {
  return ReadMessage<GrayImage>(file, place, [&](const ImageMessage& message) {
    return MaskOfMessage(file.path(), message, size);
  });
}

class RecordedDataset : public Dataset {
 public:
  RecordedDataset(DatasetInfo info,
                  std::unique_ptr<Recording> file,
                  std::vector<FrameMessages> frames,
                  std::optional<int> bits)
      : Dataset(std::move(info)), file_(std::move(file)), frames_(std::move(frames)), bits_(bits) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    const FrameMessages& messages = frames_.at(i);
    const ImageSize size = SizeOf(calibration().left);
    SensorFrame frame;
    frame.stamp_ns = stamp_ns(i);
    const auto left = Gray(messages.left, size);
    if (!left) return FailureOf(left.error(), size);
    frame.left = *left;
    if (messages.right) {
      const ImageSize right_size = calibration().right ? SizeOf(*calibration().right) : size;
      const auto right = Gray(*messages.right, right_size);
      if (!right) return FailureOf(right.error(), right_size);
      frame.right = *right;
    }
    if (messages.depth) {
      const auto depth = Depth(*messages.depth, size);
      if (!depth) return FailureOf(depth.error(), size);
      frame.depth = *depth;
    }
    frame.left_mask = Mask(messages.left_mask, frame.left);
    if (frame.right) frame.right_mask = Mask(messages.right_mask, *frame.right);
    return frame;
  }

  Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const override {
    const ImageSize size = SizeOf(calibration().left);
    auto image =
        ReadMessage<ColorImage>(*file_, frames_.at(i).left, [&](const ImageMessage& message) {
          if (message.compressed) return DecodeColorImage(info().path, message.data, Wanted(size));
          return ColorOfPixels(info().path, PixelsOf(message), Wanted(size), bits_);
        });
    if (!image) return FailureOf(image.error(), size);
    return image;
  }

 private:
  static ImageSize SizeOf(const Camera& camera) { return {camera.width(), camera.height()}; }

  std::optional<ImageSize> Wanted(ImageSize size) const {
    return info().has_calibration ? std::optional(size) : std::nullopt;
  }

  Expected<GrayImage, ImageFailure> Gray(const StoredMessage& place, ImageSize size) const {
    return ReadMessage<GrayImage>(*file_, place, [&](const ImageMessage& image) {
      return GrayOfMessage(info().path, image, Wanted(size), bits_);
    });
  }

  // The mask of an image; null without one, and if it cannot be decoded or has another size than
  // the image: what is optional costs no frame.
  std::shared_ptr<const GrayImage> Mask(const std::optional<StoredMessage>& place,
                                        const GrayImage& image) const {
    if (!place) return nullptr;
    auto mask = ReadMaskMessage(*file_, *place, ImageSize{image.width(), image.height()});
    return mask ? std::make_shared<const GrayImage>(*std::move(mask)) : nullptr;
  }

  Expected<DepthImage, ImageFailure> Depth(const StoredMessage& place, ImageSize size) const {
    const double factor = calibration().depth_factor.value_or(1);
    return ReadMessage<DepthImage>(*file_, place, [&](const ImageMessage& image) {
      return DepthOfMessage(info().path, image, factor, Wanted(size));
    });
  }

  std::unique_ptr<Recording> file_;
  std::vector<FrameMessages> frames_;
  std::optional<int> bits_;  // of grey levels of 16 bits, how many are used
};

std::vector<std::int64_t> StampsOf(const RecordedTopic& topic) {
  std::vector<std::int64_t> stamps;
  for (const RecordedImage& image : topic.images) stamps.push_back(image.stamp_ns);
  return stamps;
}

// Joins the images of the left topic with those of another one.
std::vector<FrameMessages> Join(const RecordedTopic& left,
                                const RecordedTopic& other,
                                DatasetInfo& info) {
  const bool stereo = info.sensor == SensorKind::kStereo;
  const std::int64_t most_ns = stereo ? kMaxPairDelayNs : kMaxDepthDelayNs;
  std::vector<FrameMessages> frames;
  for (const auto& [i, k] : PairByStamp(StampsOf(left), StampsOf(other), most_ns)) {
    info.stamps_ns.push_back(left.images[i].stamp_ns);
    FrameMessages frame{left.images[i].place, std::nullopt, std::nullopt};
    (stereo ? frame.right : frame.depth) = other.images[k].place;
    frames.push_back(frame);
  }
  const auto note = [&](const RecordedTopic& topic, const RecordedTopic& beside) {
    const std::size_t alone = topic.images.size() - frames.size();
    if (alone == 0) return;
    info.notes.push_back(fmt::format("{} images of {} without one of {} within {} ms are left out",
                                     alone,
                                     topic.name,
                                     beside.name,
                                     most_ns / 1'000'000));
  };
  if (frames.empty()) {
    throw InputError(fmt::format("{}: expected images of {} and {} within {} ms, found none",
                                 info.path.string(),
                                 Printable(left.name),
                                 Printable(other.name),
                                 most_ns / 1'000'000));
  }
  note(left, other);
  if (stereo) note(other, left);
  return frames;
}

// Fails for a mask that is neither a file nor a topic of images that can be read.
[[noreturn]] void FailMask(const std::string& mask, const RecordedTopics& topics) {
  const std::string file = topics.file->path().string();
  for (const Channel& channel : topics.file->channels()) {
    if (channel.topic != mask && channel.topic != mask + "/compressed") continue;
    const std::optional<MessageForm> form = FormOf(channel);
    const bool of_images =
        form && form->kind != MessageKind::kCalibration && form->kind != MessageKind::kInertial;
    throw InputError(fmt::format("{}: {}: expected images as masks, found {}{}",
                                 file,
                                 Printable(channel.topic),
                                 of_images ? "no message that can be read as " : "",
                                 Printable(channel.type)));
  }
  std::vector<const RecordedTopic*> all;
  for (const RecordedTopic& topic : topics.images) all.push_back(&topic);
  throw InputError(
      fmt::format("{}: expected an image file or a topic as a mask, found {}; topics: "
                  "{}",
                  file,
                  InQuotes(mask),
                  ListOfTopics(all)));
}

// Takes the topics that are named as masks out of the others; the masks that are files stay empty.
std::vector<std::optional<RecordedTopic>> TakeMaskTopics(const std::vector<std::string>& masks,
                                                         RecordedTopics& topics) {
  std::vector<std::optional<RecordedTopic>> taken(masks.size());
  std::error_code error;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    if (i > 0 && taken[i - 1] && masks[i] == masks[i - 1]) {
      throw InputError(fmt::format("{}: expected a topic of masks for each camera, found {} twice",
                                   topics.file->path().string(),
                                   InQuotes(masks[i])));
    }
    const auto found =
        std::find_if(topics.images.begin(), topics.images.end(), [&](const RecordedTopic& topic) {
          return topic.name == masks[i] || topic.name == masks[i] + "/compressed";
        });
    if (found != topics.images.end()) {
      taken[i] = std::move(*found);
      topics.images.erase(found);
    } else if (!fs::is_regular_file(masks[i], error)) {
      FailMask(masks[i], topics);
    }
  }
  return taken;
}

// True for a topic whose name has a part that says mask: "/people/mask", "/mask0/compressed".
bool NameSaysMask(const std::string& name) {
  std::istringstream parts(name);
  for (std::string part; std::getline(parts, part, '/');) {
    if (part == "mask" || part == "masks" || part == "mask0" || part == "mask1") return true;
  }
  return false;
}

// Leaves out the other topics of masks, unless they are named as topics or there is nothing else.
void LeaveOutMasks(const DatasetOptions& options, RecordedTopics& topics) {
  const auto is_mask = [](const RecordedTopic& topic) { return NameSaysMask(topic.name); };
  if (!options.topics.empty() || std::ranges::all_of(topics.images, is_mask)) return;
  for (const RecordedTopic& topic : topics.images) {
    if (!is_mask(topic)) continue;
    topics.notes.push_back(
        fmt::format("{} has masks by its name, which --mask uses", Printable(topic.name)));
  }
  std::erase_if(topics.images, is_mask);
}

// Gives frames the masks of their moment, and notes what they are.
void AddMasks(const Recording& file,
              const std::vector<std::optional<RecordedTopic>>& masks,
              std::vector<FrameMessages>& frames,
              DatasetInfo& info) {
  for (std::size_t camera = 0; camera < masks.size(); ++camera) {
    if (!masks[camera]) continue;
    std::vector<StoredMessage> places;
    for (const auto& [i, k] :
         PairByStamp(info.stamps_ns, StampsOf(*masks[camera]), kMaxPairDelayNs)) {
      places.push_back(masks[camera]->images[k].place);
      (camera == 0 ? frames[i].left_mask : frames[i].right_mask) = places.back();
    }
    NoteMasks(
        {places.size(), frames.size(), "of " + Printable(masks[camera]->name)},
        [&](std::size_t i) -> Expected<GrayImage, ImageFailure> {
          const std::optional<ImageSize> size = SizeOfCamera(info, camera == 1);
          Expected<GrayImage, ImageFailure> mask = ReadMaskMessage(file, places[i], size);
          if (!mask) return MaskFailureOf(mask.error(), size);
          return mask;
        },
        info);
  }
}

// Notes which topics are read, which are not, and which of the images are not.
void NoteTopics(const RecordedTopics& topics,
                const std::vector<const RecordedTopic*>& used,
                DatasetInfo& info) {
  std::vector<std::string> names;
  for (const RecordedTopic* topic : used) {
    names.push_back(topic->name);
    if (topic->without_stamp > 0) {
      info.notes.push_back(
          fmt::format("{} images of {} have no stamp: when they were recorded is "
                      "taken for it",
                      topic->without_stamp,
                      topic->name));
    }
    if (topic->broken > 0) {
      info.notes.push_back(fmt::format(
          "{} messages of {} are damaged and are left out", topic->broken, topic->name));
    }
    if (topic->again > 0) {
      info.notes.push_back(
          fmt::format("{} images of {} have the stamp of another one and are left "
                      "out",
                      topic->again,
                      topic->name));
    }
  }
  info.notes.push_back(fmt::format("topics: {}", fmt::join(names, ", ")));
  std::vector<const RecordedTopic*> others;
  for (const RecordedTopic& topic : topics.images) {
    if (std::find(used.begin(), used.end(), &topic) == used.end()) others.push_back(&topic);
  }
  if (!others.empty()) {
    info.notes.push_back("topics of images that are not used: " + ListOfTopics(others));
  }
}

// Adds a note if depth is in the frame of another camera: the default of drivers, unless they
// register it to the image.
void NoteFrames(const RecordedTopic& image, const RecordedTopic& depth, DatasetInfo& info) {
  if (image.frame.empty() || depth.frame.empty() || image.frame == depth.frame) return;
  info.notes.push_back(fmt::format(
      "the depth of {} is in the frame {}, its image in {}: depth must be registered to "
      "the image",
      depth.name,
      Printable(depth.frame),
      Printable(image.frame)));
}

// Returns the brightest level of an image of 16 bits and one channel; nullopt for others.
std::optional<int> BrightestOf(const Recording& file, const StoredMessage& place) {
  const auto bytes = file.Message(place);
  if (!bytes) return std::nullopt;
  const auto image = ParseImage(*FormOf(file.channels()[place.channel]), *bytes);
  if (!image) return std::nullopt;
  return image->compressed ? BrightestOf16Bits(image->data) : BrightestOf16Bits(PixelsOf(*image));
}

// Returns the number of used bits of 16-bit grey levels: those of the brightest level of some
// frames spread over the recording, rounded up to 8, 10, 12, 14 or 16. ROS has no field for it.
// Adds a note. Returns nullopt if the first frame has no 16-bit levels.
std::optional<int> BitsOf(const Recording& file,
                          const std::vector<FrameMessages>& frames,
                          DatasetInfo& info) {
  constexpr std::size_t kFrames = 16;
  constexpr int kMostBits = 16;
  int brightest = -1;
  std::size_t images = 0;
  const auto look = [&](const StoredMessage& place) {
    const auto level = BrightestOf(file, place);
    brightest = std::max(brightest, level.value_or(-1));
    images += level ? 1 : 0;
  };
  for (std::size_t i = 0; i < std::min(kFrames, frames.size()); ++i) {
    const FrameMessages& frame = frames[i * frames.size() / std::min(kFrames, frames.size())];
    look(frame.left);
    if (frame.right) look(*frame.right);
    if (images == 0) return std::nullopt;
  }
  if (images == 0) return std::nullopt;
  int bits = 8;
  while (bits < kMostBits && brightest >> bits > 0) bits += 2;
  info.notes.push_back(fmt::format(
      "the images have 16 bits, of which {} are used (the brightest level of {} images is "
      "{}): levels are divided by {}",
      bits,
      images,
      brightest,
      1 << (bits - 8)));
  return bits;
}

std::optional<RecordedCamera> FindCameraInfo(const RecordedTopics& topics,
                                             const RecordedTopic& image) {
  const auto* found = CalibrationFor(topics, image);
  if (found == nullptr || !IsCalibrated(found->second)) return std::nullopt;
  return RecordedCamera{found->second,
                        topics.file->path().string() + ": " + Printable(found->first),
                        IsRectifiedByName(image.name)};
}

std::string NoCameraInfo(const fs::path& path, const RecordedTopic& image) {
  return fmt::format(
      "{}: expected a calibration of {} (sensor_msgs/CameraInfo), found none: give --camera FILE, "
      "or put a camera.yaml beside the file (built-in cameras: {})",
      path.string(),
      Printable(image.name),
      fmt::join(BuiltInCameras(), ", "));
}

std::optional<CameraFile> ReadCalibration(const RecordedTopics& topics,
                                          const ChosenTopics& chosen,
                                          SensorKind sensor,
                                          const DatasetOptions& options) {
  const fs::path& path = topics.file->path();
  std::error_code error;
  const fs::path folder = fs::is_directory(path, error) ? path : path.parent_path();
  if (auto given = GivenCamera(folder, options, sensor)) return given;
  const bool stereo = sensor == SensorKind::kStereo;
  const std::optional<RecordedCamera> left = FindCameraInfo(topics, *chosen.left);
  const std::optional<RecordedCamera> right =
      stereo ? FindCameraInfo(topics, *chosen.right) : std::nullopt;
  if (!left || (stereo && !right)) {
    if (options.allow_missing_camera) return std::nullopt;
    throw InputError(NoCameraInfo(path, left ? *chosen.right : *chosen.left));
  }
  CameraFile camera{CalibrationOf(*left, right), left->source};
  if (right) camera.source += " and " + CalibrationFor(topics, *chosen.right)->first;
  return camera;
}

std::vector<SensorKind> Available(const ChosenTopics& chosen) {
  std::vector<SensorKind> available;
  if (chosen.right != nullptr) available.push_back(SensorKind::kStereo);
  if (chosen.depth != nullptr) available.push_back(SensorKind::kRgbd);
  available.push_back(SensorKind::kMono);
  return available;
}

// Sets the depth factor. Depth in metres needs none, whatever the camera file says.
void SetDepthFactor(const RecordedTopic& depth, DatasetInfo& info) {
  std::optional<double>& factor = info.calibration.depth_factor;
  if (IsInMetres(depth.encoding)) {
    factor = 1;
  } else if (!factor) {
    factor = kMillimetres;
  }
}

}  // namespace

std::unique_ptr<Dataset> OpenRecording(const fs::path& path,
                                       DatasetFormat format,
                                       const DatasetOptions& options) {
  RecordedTopics topics = ReadTopics(path, format);
  const std::vector<std::optional<RecordedTopic>> masks = TakeMaskTopics(options.masks, topics);
  LeaveOutMasks(options, topics);
  const ChosenTopics chosen = ChooseTopics(topics, options.topics, options.sensor);
  DatasetInfo info = DescribeDataset(path, format, Available(chosen), options);
  info.notes = topics.notes;
  const auto camera = ReadCalibration(topics, chosen, info.sensor, options);
  info.has_calibration = false;
  if (camera) UseCamera(*camera, info);
  AddGroundTruth({}, options, info);
  if (info.sensor == SensorKind::kRgbd) SetDepthFactor(*chosen.depth, info);
  std::vector<FrameMessages> frames;
  std::vector<const RecordedTopic*> used = {chosen.left};
  if (info.sensor == SensorKind::kMono) {
    for (const RecordedImage& image : chosen.left->images) {
      info.stamps_ns.push_back(image.stamp_ns);
      frames.push_back({image.place, std::nullopt, std::nullopt});
    }
  } else {
    used.push_back(info.sensor == SensorKind::kStereo ? chosen.right : chosen.depth);
    frames = Join(*chosen.left, *used.back(), info);
    if (info.sensor == SensorKind::kRgbd) NoteFrames(*chosen.left, *chosen.depth, info);
  }
  for (const std::optional<RecordedTopic>& mask : masks) {
    if (mask) used.push_back(&*mask);
  }
  NoteTopics(topics, used, info);
  AddMasks(*topics.file, masks, frames, info);
  NoteRate(info);
  const std::optional<int> bits = BitsOf(*topics.file, frames, info);
  auto dataset = std::make_unique<RecordedDataset>(
      std::move(info), std::move(topics.file), std::move(frames), bits);
  CheckFirstFrame(*dataset);
  return dataset;
}

}  // namespace plumbline
