// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/image_header.h"
#include "plumbline/live/live_source.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Who takes images of devices includes OpenCV and opencv_modules.h itself.
namespace cv {
class Mat;
}

namespace plumbline {

class VideoCapture;

// Returns the devices of "camera:0,1" or "camera:/dev/video2": numbers, or paths as they are.
// Throws InputError unless there are one or two.
std::vector<std::string> CameraDevices(const std::string& name);

// Returns the pipeline of "gst:PIPELINE", with a sink for this program added where it has none.
std::string GstreamerPipeline(const std::string& name);

// Returns what is opened for a source: devices, a pipeline, or the address of a stream.
std::vector<std::string> CapturesOf(const std::string& name, LiveKind kind);

// Returns the size of the images that each device is to be asked for: for one device for each
// camera those of the cameras, the left one first; where side_by_side, for the one device whose
// images show both cameras, twice the width of the left one.
std::vector<ImageSize> DeviceSizes(const Calibration& calibration, bool side_by_side);

// The times of frames; see OpenCapture.
class FrameClock {
 public:
  // Returns the stamp of a frame. device_ms: its time by the driver's clock; 0 or less if that has
  // none.
  std::int64_t StampOf(double device_ms);

 private:
  std::optional<std::chrono::steady_clock::time_point> start_;
  std::int64_t first_ns_ = 0;
  double first_device_ms_ = 0;
};

// The images of one instant as the devices deliver them.
struct CapturedImages {
  std::int64_t stamp_ns = 0;
  std::vector<cv::Mat> images;  // an image that could not be read is empty
};

// The devices, the stream or the pipeline of a source, which are opened together.
class CaptureDevices {
 public:
  using NewCapture = std::function<std::unique_ptr<VideoCapture>()>;

  // Opens them. sizes: for each camera the size of its images to ask for, since a driver begins
  // with another one; cameras beyond them are taken as they are. A device that does not have the
  // size delivers another one. new_capture makes captures in place of OpenCV's. Throws InputError
  // where one cannot be opened.
  CaptureDevices(const std::string& name,
                 LiveKind kind,
                 std::vector<ImageSize> sizes,
                 NewCapture new_capture = {});

  // Opens all devices, for the first time or again; returns false where one of them cannot be
  // opened.
  bool Open();

  // A camera or a stream may come back; a pipeline that has ended does not.
  bool MayComeBack() const { return kind_ != LiveKind::kGstreamer; }

  // Returns nullopt when there are no more images.
  std::optional<CapturedImages> Take();

 private:
  LiveKind kind_;
  std::vector<std::string> parts_;  // names of what is opened
  std::vector<ImageSize> sizes_;
  NewCapture new_capture_;  // empty: OpenCV's
  std::vector<std::unique_ptr<VideoCapture>> captures_;
  FrameClock clock_;
};

}  // namespace plumbline
