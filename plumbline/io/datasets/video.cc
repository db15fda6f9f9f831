// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/opencv_modules.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/frame_preparation.h"
#include "plumbline/io/datasets/ground_truth.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<VideoDecoder> OpenDecoder(const fs::path& path) {
  std::unique_ptr<VideoDecoder> decoder = LoadOpenCvModules().OpenVideo(path.string());
  if (decoder == nullptr) {
    throw InputError(path.string() +
                     ": expected a folder or a video, found a file that cannot be decoded");
  }
  if (decoder->properties().is_text) {
    throw InputError(path.string() + ": expected a folder or a video, found a text");
  }
  return decoder;
}

// Results of one pass over a video.
struct VideoContent {
  VideoProperties properties;
  ImageSize size;                       // of the first frame
  std::size_t decoded = 0;              // frames
  std::vector<std::size_t> frames;      // those that are used, as numbers of decoded ones
  std::vector<std::int64_t> stamps_ns;  // their times
  std::vector<std::string> notes;
};

using ShownAt = std::vector<std::optional<std::int64_t>>;  // time of each decoded frame

// Returns as many frames as there can be whose times increase.
std::vector<std::size_t> IncreasingFrames(const ShownAt& times) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> last;  // by length: the frame of the earliest time that ends such a row
  std::vector<std::size_t> before(times.size(), kNone);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!times[i]) continue;
    const auto at =
        std::lower_bound(last.begin(), last.end(), i, [&](std::size_t a, std::size_t b) {
          return times[a] < times[b];
        });
    if (at != last.begin()) before[i] = *(at - 1);
    if (at == last.end()) {
      last.push_back(i);
    } else {
      *at = i;
    }
  }
  std::vector<std::size_t> frames;
  for (std::size_t i = last.empty() ? kNone : last.back(); i != kNone; i = before[i]) {
    frames.push_back(i);
  }
  std::reverse(frames.begin(), frames.end());
  return frames;
}

// Frames as far apart as the container's rate says, for a container without times that can be used.
void UseEvenTimes(const fs::path& path, VideoContent& content) {
  const double rate_hz = content.properties.rate_hz;
  if (rate_hz == 0) {
    throw InputError(path.string() +
                     ": expected times or a frame rate in the container, found neither");
  }
  content.notes.push_back(fmt::format(
      "the container has no times that increase for most frames: its rate of {:.4g} Hz is used",
      rate_hz));
  for (std::size_t i = 0; i < content.decoded; ++i) {
    content.frames.push_back(i);
    content.stamps_ns.push_back(std::llround(1e9 * static_cast<double>(i) / rate_hz));
  }
}

// Takes the container's times. Frames without one, and as few others as can be, are left out so
// that times increase.
void UseTimes(const fs::path& path, const ShownAt& times, VideoContent& content) {
  content.decoded = times.size();
  std::vector<std::size_t> frames = IncreasingFrames(times);
  if (2 * frames.size() < times.size()) return UseEvenTimes(path, content);
  // Times before the start of the video are those of a container that is wrong about its start.
  const std::int64_t start_ns = std::min<std::int64_t>(*times[frames.front()], 0);
  for (const std::size_t i : frames) content.stamps_ns.push_back(*times[i] - start_ns);
  const std::size_t left_out = times.size() - frames.size();
  content.frames = std::move(frames);
  if (left_out == 0) return;
  std::size_t first = 0;
  while (first < content.frames.size() && content.frames[first] == first) ++first;
  content.notes.push_back(
      fmt::format("{} of {} frames are left out, the first of them frame {}: they have no time, or "
                  "one that does not fit between those of their neighbours",
                  left_out,
                  times.size(),
                  first));
}

VideoContent Scan(const fs::path& path) {
  const std::unique_ptr<VideoDecoder> decoder = OpenDecoder(path);
  VideoContent content;
  double& rate_hz = content.properties.rate_hz;
  rate_hz = decoder->properties().rate_hz;
  if (RateFault(rate_hz)) rate_hz = 0;
  ShownAt times;
  std::size_t guessed = 0;
  while (decoder->Next()) {
    if (times.empty()) content.size = {decoder->width(), decoder->height()};
    std::optional<std::int64_t> time = decoder->time_ns();
    if (time && (*time > kLatestStampNs || *time < -kLatestStampNs)) time.reset();
    if (!time && rate_hz > 0 && !times.empty() && times.back()) {
      time = *times.back() + std::llround(1e9 / rate_hz);
      ++guessed;
    }
    times.push_back(time);
  }
  if (times.empty()) {
    throw InputError(path.string() + ": expected a video, found one without frames");
  }
  if (guessed > 0) {
    content.notes.push_back(fmt::format(
        "{} of {} frames have no time: each is taken {:.4g} ms after the frame before, by the "
        "container's rate",
        guessed,
        times.size(),
        1e3 / rate_hz));
  }
  content.properties = {
      rate_hz, decoder->properties().frames, false, decoder->properties().orientation};
  UseTimes(path, times, content);
  return content;
}

class VideoDataset : public Dataset {
 public:
  VideoDataset(DatasetInfo info, ImageSize size, std::vector<std::size_t> frames)
      : Dataset(std::move(info)),
        size_(size),
        frames_(std::move(frames)),
        decoder_(OpenDecoder(this->info().path)) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    SensorFrame frame;
    frame.stamp_ns = stamp_ns(i);
    Expected<cv::Mat, ImageFailure> decoded = Decode(i);
    if (!decoded) return decoded.error();
    frame.left = GrayImage(decoded->cols, decoded->rows);
    cv::Mat gray = AsMat(frame.left);
    cv::cvtColor(*decoded, gray, cv::COLOR_BGR2GRAY);
    return frame;
  }

  Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const override {
    const Expected<cv::Mat, ImageFailure> decoded = Decode(i);
    if (!decoded) return decoded.error();
    const cv::Mat& image = *decoded;
    const std::size_t size = image.step * static_cast<std::size_t>(image.rows);
    return FromInterleaved(image.cols, image.rows, {{image.data, size}, image.step});
  }

 private:
  // Returns the frame in blue, green and red, of 8 bits.
  Expected<cv::Mat, ImageFailure> Decode(std::size_t i) const {
    const std::lock_guard lock(mutex_);
    if (frames_.at(i) < next_) {
      decoder_ = OpenDecoder(info().path);
      next_ = 0;
    }
    while (next_ <= frames_[i]) {
      if (!decoder_->Next()) return Failure(i, "the video ends early");
      ++next_;
    }
    if (ImageSize{decoder_->width(), decoder_->height()} != size_) {
      return Failure(i, "it is of another size than the first one");
    }
    cv::Mat image;
    if (!decoder_->Retrieve(image)) return Failure(i, "it cannot be decoded");
    return image;
  }

  ImageFailure Failure(std::size_t i, const char* why) const {
    return {info().path, fmt::format("frame {}: {}", i, why)};
  }

  ImageSize size_;
  std::vector<std::size_t> frames_;  // as numbers of decoded ones
  mutable std::mutex mutex_;
  mutable std::unique_ptr<VideoDecoder> decoder_;
  mutable std::size_t next_ = 0;  // the frame that the decoder gives next
};

void CheckSize(const DatasetInfo& info, const VideoContent& content) {
  const Camera& camera = info.calibration.left;
  if (content.size == ImageSize{camera.width(), camera.height()}) return;
  throw InputError(
      fmt::format("{}: expected a video of {}x{} pixels as in the calibration, found {}x{}",
                  info.path.string(),
                  camera.width(),
                  camera.height(),
                  content.size.width,
                  content.size.height));
}

}  // namespace

std::unique_ptr<Dataset> OpenVideo(const fs::path& path, const DatasetOptions& options) {
  OpenDecoder(path);  // reports a file that is no video before missing inputs
  DatasetInfo info = DescribeDataset(path, DatasetFormat::kVideo, {SensorKind::kMono}, options);
  std::optional<CameraFile> camera = GivenCamera(path.parent_path(), options);
  if (!camera && !options.allow_missing_camera) throw InputError(NoCalibration(path));
  info.has_calibration = false;
  if (camera) UseCamera(*std::move(camera), info);
  AddGroundTruth({}, options, info);
  VideoContent content = Scan(path);
  const VideoProperties& properties = content.properties;
  const auto decoded = static_cast<std::int64_t>(content.decoded);
  if (properties.frames > decoded) {
    info.notes.push_back(fmt::format(
        "{} of {} frames cannot be decoded", properties.frames - decoded, properties.frames));
  }
  for (std::string& note : content.notes) info.notes.push_back(std::move(note));
  if (!properties.orientation) {
    info.notes.emplace_back(
        "the file asks for images that are turned by another angle than quarters; they are used as "
        "stored");
  }
  const ImageTurn turn = ChooseTurn(
      options.rotate, properties.orientation.value_or(Orientation{}), content.size, info);
  if (info.has_calibration) CheckSize(info, content);
  if (!info.calibration.rate_hz && properties.rate_hz > 0) {
    info.calibration.rate_hz = properties.rate_hz;
  }
  info.stamps_ns = std::move(content.stamps_ns);
  auto video =
      std::make_unique<VideoDataset>(std::move(info), content.size, std::move(content.frames));
  return PrepareFrames(std::move(video), turn, PreparationOf(options));
}

}  // namespace plumbline
