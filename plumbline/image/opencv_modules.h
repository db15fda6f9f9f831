// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/resample.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace plumbline {

// The functions of cv::VideoCapture; see there. Backends are its constants cv::CAP_...
class VideoCapture {
 public:
  virtual ~VideoCapture() = default;

  // parameters: pairs of cv::CAP_PROP_... and values.
  virtual bool Open(const std::string& name,
                    int backend,
                    const std::vector<int>& parameters = {}) = 0;
  virtual bool Open(int device, int backend) = 0;
  virtual bool Grab() = 0;
  virtual bool Retrieve(cv::Mat& image) = 0;
  virtual double Get(int property) const = 0;
  virtual void Set(int property, double value) = 0;
};

// Metadata in the container of a video.
struct VideoProperties {
  double rate_hz = 0;       // mean frames per second; 0: not stated
  std::int64_t frames = 0;  // announced number of frames; 0: not stated
  bool is_text = false;     // a text file, which FFmpeg draws letter by letter as a terminal does
  // Orientation applied by players. nullopt: one that Orientation cannot express.
  std::optional<Orientation> orientation = Orientation{};
};

// The frames of a video file, decoded one after the other by FFmpeg's libraries: in display order,
// without those that an edit list cuts away.
class VideoDecoder {
 public:
  VideoDecoder() = default;
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;
  virtual ~VideoDecoder() = default;

  virtual const VideoProperties& properties() const = 0;
  // Decodes the next frame. Returns false after the last one. Skips frames that cannot be decoded.
  virtual bool Next() = 0;
  // Display time of the frame that Next() decoded, nanoseconds since the start of the video;
  // nullopt if the container does not state it.
  virtual std::optional<std::int64_t> time_ns() const = 0;
  virtual int width() const = 0;
  virtual int height() const = 0;
  // Its pixels, 8 bits each of blue, green and red. Returns false if they cannot be converted.
  virtual bool Retrieve(cv::Mat& image) const = 0;
};

// Functions of OpenCV's modules imgcodecs, videoio and ximgproc, and of FFmpeg. These bring
// GStreamer and GDAL along, some 230 libraries that take half a second and 60 MB to load, and most
// runs need none of them. A separate library therefore links them, which is loaded on first use.
class OpenCvModules {
 public:
  virtual ~OpenCvModules() = default;

  // Equals cv::imdecode; the result is empty if that fails.
  virtual cv::Mat DecodeImage(std::span<const std::uint8_t> bytes, int flags) const = 0;
  // For cameras and streams.
  virtual std::unique_ptr<VideoCapture> NewVideoCapture() const = 0;
  // Opens a video file. Returns nullptr if it is not a video.
  virtual std::unique_ptr<VideoDecoder> OpenVideo(const std::string& path) const = 0;
  // Returns line segments by cv::ximgproc::EdgeDrawing, each from (x, y) to (x, y).
  virtual std::vector<cv::Vec4f> EdgeDrawingLines(const cv::Mat& image) const = 0;
};

// Loads the library libplumbline_opencv.so at the first call, from its build folder or its
// installation beside the program. Throws InputError if it cannot be loaded. Thread-safe.
const OpenCvModules& LoadOpenCvModules();

}  // namespace plumbline
