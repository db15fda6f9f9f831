// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/orientation.h"

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

// What the container of a video says.
struct VideoProperties {
  double rate_hz = 0;       // mean frames per second; 0: it tells none
  std::int64_t frames = 0;  // frames that it announces; 0: it announces none
  bool is_text = false;     // a text file, which FFmpeg draws letter by letter as a terminal does
  // How players turn the images. nullopt: in a way that Orientation cannot express.
  std::optional<Orientation> orientation = Orientation{};
};

// The frames of a video file, one after the other, as FFmpeg's libraries decode them: in the order
// in which they are shown, without those that an edit list cuts away.
class VideoDecoder {
 public:
  VideoDecoder() = default;
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;
  virtual ~VideoDecoder() = default;

  virtual const VideoProperties& properties() const = 0;
  // Decodes the next frame. Returns false behind the last one. Frames that cannot be decoded are
  // left out.
  virtual bool Next() = 0;
  // About the frame that Next() decoded. When it is shown, nanoseconds since the start of the
  // video; nullopt where the container does not say.
  virtual std::optional<std::int64_t> time_ns() const = 0;
  virtual int width() const = 0;
  virtual int height() const = 0;
  // Its pixels, 8 bits each of blue, green and red. Returns false where there is no conversion.
  virtual bool Retrieve(cv::Mat& image) const = 0;
};

// What the program needs of OpenCV's modules imgcodecs, videoio and ximgproc, and of FFmpeg. They
// bring GStreamer and GDAL along, some 230 libraries that take half a second and 60 MB to load, and
// most runs need none of them. A library of its own therefore links them, which is loaded when it
// is first needed.
class OpenCvModules {
 public:
  virtual ~OpenCvModules() = default;

  // Does what cv::imdecode does; the result is empty where that refuses.
  virtual cv::Mat DecodeImage(std::span<const std::uint8_t> bytes, int flags) const = 0;
  // For cameras and streams.
  virtual std::unique_ptr<VideoCapture> NewVideoCapture() const = 0;
  // Opens a video file. Returns nullptr where it is none.
  virtual std::unique_ptr<VideoDecoder> OpenVideo(const std::string& path) const = 0;
  // Returns line segments by cv::ximgproc::EdgeDrawing, each from (x, y) to (x, y).
  virtual std::vector<cv::Vec4f> EdgeDrawingLines(const cv::Mat& image) const = 0;
};

// Loads the library libplumbline_opencv.so at the first call, from where it was built or was
// installed beside the program. Throws InputError where it cannot be loaded. May be called by
// several threads.
const OpenCvModules& LoadOpenCvModules();

}  // namespace plumbline
