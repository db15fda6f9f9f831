// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/capture_devices.h"

#include "plumbline/base/printable.h"
#include "plumbline/image/opencv_modules.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace plumbline {
namespace {

constexpr int kTimeoutMs = 10'000;
constexpr int kHighestNumber = 999;  // highest number of a device

std::optional<int> DeviceNumber(const std::string& device) {
  int number = 0;
  const auto [end, error] = std::from_chars(device.data(), device.data() + device.size(), number);
  const bool whole = error == std::errc() && end == device.data() + device.size();
  return whole && number >= 0 && number <= kHighestNumber ? std::optional(number) : std::nullopt;
}

bool OpenDevice(VideoCapture& capture, const std::string& device, const ImageSize* size) {
  const auto number = DeviceNumber(device);
  const bool is_open =
      number ? capture.Open(*number, cv::CAP_V4L2) : capture.Open(device, cv::CAP_V4L2);
  if (is_open && size != nullptr) {
    // The driver is asked once both are set.
    capture.Set(cv::CAP_PROP_FRAME_WIDTH, size->width);
    capture.Set(cv::CAP_PROP_FRAME_HEIGHT, size->height);
  }
  return is_open;
}

bool OpenAs(LiveKind kind, VideoCapture& capture, const std::string& what, const ImageSize* size) {
  try {
    switch (kind) {
      case LiveKind::kCamera:
        return OpenDevice(capture, what, size);
      case LiveKind::kNetwork:
        return capture.Open(what,
                            cv::CAP_FFMPEG,
                            {cv::CAP_PROP_OPEN_TIMEOUT_MSEC,
                             kTimeoutMs,
                             cv::CAP_PROP_READ_TIMEOUT_MSEC,
                             kTimeoutMs});
      case LiveKind::kGstreamer:
        return capture.Open(what, cv::CAP_GSTREAMER);
      case LiveKind::kStandardInput:
        break;
    }
  } catch (const cv::Exception&) {
    return false;
  }
  throw BugError("a source that is not captured");
}

}  // namespace

std::vector<std::string> CameraDevices(const std::string& name) {
  std::vector<std::string> devices;
  std::string rest = name.substr(name.find(':') + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    devices.push_back(rest.substr(0, comma));
    if (comma == std::string::npos) break;
    rest = rest.substr(comma + 1);
  }
  const bool good = std::all_of(devices.begin(), devices.end(), [](const std::string& device) {
    return device.starts_with('/') || DeviceNumber(device).has_value();
  });
  if (good && devices.size() <= 2) return devices;
  throw InputError("expected camera:N or camera:N,M with numbers or paths of devices, found " +
                   InQuotes(name));
}

std::string GstreamerPipeline(const std::string& name) {
  std::string pipeline = name.substr(name.find(':') + 1);
  if (pipeline.find("appsink") == std::string::npos) pipeline += " ! videoconvert ! appsink";
  return pipeline;
}

std::vector<std::string> CapturesOf(const std::string& name, LiveKind kind) {
  if (kind == LiveKind::kCamera) return CameraDevices(name);
  if (kind == LiveKind::kGstreamer) return {GstreamerPipeline(name)};
  return {name};
}

std::vector<ImageSize> DeviceSizes(const Calibration& calibration, bool side_by_side) {
  const auto size_of = [](const Camera& camera) {
    return ImageSize{camera.width(), camera.height()};
  };
  std::vector<ImageSize> sizes = {size_of(calibration.left)};
  if (side_by_side) {
    sizes[0].width *= 2;
  } else if (calibration.right) {
    sizes.push_back(size_of(*calibration.right));
  }
  return sizes;
}

std::int64_t FrameClock::StampOf(double device_ms) {
  const auto now = std::chrono::steady_clock::now();
  if (!start_) {
    start_ = now;
    first_device_ms_ = device_ms;
    const auto time = std::chrono::system_clock::now().time_since_epoch();
    first_ns_ = std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
  }
  if (first_device_ms_ > 0 && device_ms > 0) {
    return first_ns_ + std::llround(1e6 * (device_ms - first_device_ms_));
  }
  return first_ns_ + std::chrono::duration_cast<std::chrono::nanoseconds>(now - *start_).count();
}

CaptureDevices::CaptureDevices(const std::string& name,
                               LiveKind kind,
                               std::vector<ImageSize> sizes,
                               NewCapture new_capture)
    : kind_(kind),
      parts_(CapturesOf(name, kind)),
      sizes_(std::move(sizes)),
      new_capture_(std::move(new_capture)) {
  if (Open()) return;
  throw InputError(fmt::format("{}: expected {}, found none that can be opened",
                               Printable(WithoutPassword(name), kLongestMessage),
                               kind == LiveKind::kCamera      ? "a camera"
                               : kind == LiveKind::kGstreamer ? "a GStreamer pipeline"
                                                              : "a stream"));
}

bool CaptureDevices::Open() {
  captures_.clear();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    captures_.push_back(new_capture_ ? new_capture_() : LoadOpenCvModules().NewVideoCapture());
    const ImageSize* size = i < sizes_.size() ? &sizes_[i] : nullptr;
    if (!OpenAs(kind_, *captures_.back(), parts_[i], size)) return false;
  }
  return true;
}

std::optional<CapturedImages> CaptureDevices::Take() {
  CapturedImages taken;
  try {
    for (const auto& capture : captures_) {
      if (!capture->Grab()) return std::nullopt;
      if (&capture != captures_.data()) continue;
      const bool camera = kind_ == LiveKind::kCamera;
      taken.stamp_ns = clock_.StampOf(camera ? capture->Get(cv::CAP_PROP_POS_MSEC) : 0);
    }
    for (const auto& capture : captures_) {
      taken.images.emplace_back();
      if (!capture->Retrieve(taken.images.back())) taken.images.back().release();
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return taken;
}

}  // namespace plumbline
