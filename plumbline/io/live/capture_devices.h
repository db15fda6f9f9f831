// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/live/live_source.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Users of device images include OpenCV and opencv_modules.h themselves.
namespace cv {
class Mat;
}

namespace plumbline {

class VideoCapture;

// Returns the devices of "camera:0,1" or "camera:/dev/video2": numbers, or paths as given. Throws
// InputError unless there are one or two.
std::vector<std::string> CameraDevices(const std::string& name);

// Returns the pipeline of "gst:PIPELINE", with a sink for this program added if it has none.
std::string GstreamerPipeline(const std::string& name);

// Returns the devices, the pipeline, or the address of the stream of a source.
std::vector<std::string> CapturesOf(const std::string& name, LiveKind kind);

// Returns the image size to request from each device: with one device per camera those of the
// cameras, the left one first; with side_by_side, for the one device whose images show both
// cameras, twice the width of the left one.
std::vector<ImageSize> DeviceSizes(const Calibration& calibration, bool side_by_side);

// Times of frames; see OpenCapture.
class FrameClock {
 public:
  // Returns the stamp of a frame. device_ms: its time by the driver's clock; 0 or less if it has
  // none.
  std::int64_t StampOf(double device_ms);

 private:
  std::optional<std::chrono::steady_clock::time_point> start_;
  std::int64_t first_ns_ = 0;
  double first_device_ms_ = 0;
};

// The images of one instant as delivered by the devices.
struct CapturedImages {
  std::int64_t stamp_ns = 0;
  std::vector<cv::Mat> images;  // unreadable images are empty
};

// The devices, the stream or the pipeline of a source, opened together.
class CaptureDevices {
 public:
  using NewCapture = std::function<std::unique_ptr<VideoCapture>()>;

  // Opens them. sizes: image size to request for each camera, since the driver's default may
  // differ; further cameras keep their default. A device without that size delivers another one.
  // new_capture creates captures in place of OpenCV's. Throws InputError if one cannot be opened.
  CaptureDevices(const std::string& name,
                 LiveKind kind,
                 std::vector<ImageSize> sizes,
                 NewCapture new_capture = {});

  // Opens all devices, for the first time or again; returns false if one of them cannot be opened.
  bool Open();

  // Returns true for cameras and streams; a pipeline that has ended does not come back.
  bool MayComeBack() const { return kind_ != LiveKind::kGstreamer; }

  // Returns nullopt if there are no more images.
  std::optional<CapturedImages> Take();

 private:
  LiveKind kind_;
  std::vector<std::string> parts_;  // names of devices, pipeline or stream
  std::vector<ImageSize> sizes_;
  NewCapture new_capture_;  // empty: OpenCV's
  std::vector<std::unique_ptr<VideoCapture>> captures_;
  FrameClock clock_;
};

}  // namespace plumbline
