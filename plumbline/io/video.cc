// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/video.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/plausible_calibration.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/opencv_modules.h"
#include "plumbline/io/camera_file.h"
#include "plumbline/io/decoder_messages.h"
#include "plumbline/io/image_dataset.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// The decoder by which FFmpeg draws a text letter by letter, as a terminal does.
constexpr int kTerminal = 'a' | 'n' << 8 | 's' << 16 | 'i' << 24;

std::unique_ptr<VideoCapture> OpenCapture(const fs::path& path) {
  const DecoderCall call;
  std::unique_ptr<VideoCapture> capture = LoadOpenCvModules().NewVideoCapture();
  bool is_open = false;
  try {
    is_open = capture->Open(path.string(), cv::CAP_FFMPEG);  // other backends write to the terminal
  } catch (const cv::Exception&) {
    is_open = false;
  }
  if (!is_open) {
    throw InputError(path.string() +
                     ": expected a folder or a video, found a file that cannot be decoded");
  }
  if (static_cast<int>(capture->Get(cv::CAP_PROP_FOURCC)) == kTerminal) {
    throw InputError(path.string() + ": expected a folder or a video, found a text");
  }
  capture->Set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  return capture;
}

// What is known after going through a video once.
struct VideoContent {
  int width = 0, height = 0;
  double announced_frames = 0;  // as the container says
  double rate_hz = 0;           // 0: the container tells none
  double turned_deg = 0;        // by which a player turns the images, to either side
  std::vector<std::int64_t> stamps_ns;
};

bool Increasing(const std::vector<std::int64_t>& stamps) {
  return std::adjacent_find(stamps.begin(), stamps.end(), std::greater_equal<>()) == stamps.end();
}

VideoContent Scan(const fs::path& path) {
  const DecoderCall call;
  const std::unique_ptr<VideoCapture> capture = OpenCapture(path);
  VideoContent content;
  content.width = static_cast<int>(capture->Get(cv::CAP_PROP_FRAME_WIDTH));
  content.height = static_cast<int>(capture->Get(cv::CAP_PROP_FRAME_HEIGHT));
  content.announced_frames = capture->Get(cv::CAP_PROP_FRAME_COUNT);
  const double rate = capture->Get(cv::CAP_PROP_FPS);
  if (!RateFault(rate)) content.rate_hz = rate;
  // Versions of OpenCV count to opposite sides.
  const double turned_deg = capture->Get(cv::CAP_PROP_ORIENTATION_META);
  content.turned_deg = std::min(turned_deg, 360 - turned_deg);
  while (capture->Grab()) {
    const double milliseconds = capture->Get(cv::CAP_PROP_POS_MSEC);
    // Times that cannot be right do not increase, so that the rate takes their place.
    const bool plausible = std::abs(1e6 * milliseconds) <= static_cast<double>(kLatestStampNs);
    content.stamps_ns.push_back(plausible ? std::llround(1e6 * milliseconds) : 0);
  }
  if (content.stamps_ns.empty()) {
    throw InputError(path.string() + ": expected a video, found one without frames");
  }
  if (!Increasing(content.stamps_ns)) {
    if (content.rate_hz == 0) {
      throw InputError(path.string() +
                       ": expected times or a frame rate in the container, found neither");
    }
    for (std::size_t i = 0; i < content.stamps_ns.size(); ++i) {
      content.stamps_ns[i] = std::llround(1e9 * static_cast<double>(i) / content.rate_hz);
    }
  }
  return content;
}

class VideoDataset : public Dataset {
 public:
  explicit VideoDataset(DatasetInfo info)
      : Dataset(std::move(info)), capture_(OpenCapture(this->info().path)) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    SensorFrame frame;
    frame.stamp_ns = stamp_ns(i);
    Expected<cv::Mat, ImageFailure> decoded = Decode(i);
    if (!decoded) return decoded.error();
    cv::Mat image = *decoded;
    if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
    frame.left = ToImage<std::uint8_t>(image);
    return frame;
  }

  Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const override {
    const Expected<cv::Mat, ImageFailure> decoded = Decode(i);
    if (!decoded) return decoded.error();
    const cv::Mat& image = *decoded;
    if (image.channels() == 1) return ToColor(ToImage<std::uint8_t>(image));
    const std::size_t size = image.step * static_cast<std::size_t>(image.rows);
    return FromInterleaved(image.cols, image.rows, {{image.data, size}, image.step});
  }

 private:
  // Returns the frame, grey or in blue, green and red, of 8 bits.
  Expected<cv::Mat, ImageFailure> Decode(std::size_t i) const {
    const std::lock_guard lock(mutex_);
    const DecoderCall call;
    if (i < next_) {
      capture_ = OpenCapture(info().path);
      next_ = 0;
    }
    while (next_ <= i) {
      if (!capture_->Grab()) return Failure(i, "the video ends early");
      ++next_;
    }
    cv::Mat image;
    if (!capture_->Retrieve(image) || image.empty()) return Failure(i, "it cannot be decoded");
    if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
      return Failure(i, "expected 8 bits a colour");
    }
    return image;
  }

  ImageFailure Failure(std::size_t i, const char* why) const {
    return {info().path, fmt::format("frame {}: {}", i, why)};
  }

  mutable std::mutex mutex_;
  mutable std::unique_ptr<VideoCapture> capture_;
  mutable std::size_t next_ = 0;  // the frame that the capture gives next
};

void CheckSize(const DatasetInfo& info, const VideoContent& content) {
  const Camera& camera = info.calibration.left;
  if (content.width == camera.width() && content.height == camera.height()) return;
  throw InputError(
      fmt::format("{}: expected a video of {}x{} pixels as in the calibration, found {}x{}",
                  info.path.string(),
                  camera.width(),
                  camera.height(),
                  content.width,
                  content.height));
}

}  // namespace

std::unique_ptr<Dataset> OpenVideo(const fs::path& path, const DatasetOptions& options) {
  OpenCapture(path);  // a file that is no video is reported before what is missing for one
  DatasetInfo info = DescribeDataset(path, DatasetFormat::kVideo, {SensorKind::kMono}, options);
  std::optional<CameraFile> camera = GivenCamera(path.parent_path(), options);
  if (!camera && !options.allow_missing_camera) throw InputError(NoCalibration(path));
  info.has_calibration = false;
  if (camera) UseCamera(*std::move(camera), info);
  VideoContent content = Scan(path);
  if (info.has_calibration) CheckSize(info, content);
  const auto frames = static_cast<double>(content.stamps_ns.size());
  if (content.announced_frames > frames) {
    info.notes.push_back(fmt::format("{:.0f} of {:.0f} frames cannot be decoded",
                                     content.announced_frames - frames,
                                     content.announced_frames));
  }
  if (content.turned_deg > 0) {
    info.notes.push_back(fmt::format(
        "the file says that its images are turned by {:.0f} degrees; they are used as stored",
        content.turned_deg));
  }
  if (!info.calibration.rate_hz && content.rate_hz > 0) info.calibration.rate_hz = content.rate_hz;
  info.stamps_ns = std::move(content.stamps_ns);
  return std::make_unique<VideoDataset>(std::move(info));
}

}  // namespace plumbline
