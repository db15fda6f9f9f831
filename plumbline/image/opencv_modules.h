// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
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

// What the program needs of OpenCV's modules imgcodecs, videoio and ximgproc. They bring FFmpeg,
// GStreamer and GDAL along, some 230 libraries that take half a second and 60 MB to load, and most
// runs need none of them. A library of its own therefore links them, which is loaded when it is
// first needed.
class OpenCvModules {
 public:
  virtual ~OpenCvModules() = default;

  // Does what cv::imdecode does; the result is empty where that refuses.
  virtual cv::Mat DecodeImage(std::span<const std::uint8_t> bytes, int flags) const = 0;
  virtual std::unique_ptr<VideoCapture> NewVideoCapture() const = 0;
  // Returns line segments by cv::ximgproc::EdgeDrawing, each from (x, y) to (x, y).
  virtual std::vector<cv::Vec4f> EdgeDrawingLines(const cv::Mat& image) const = 0;
};

// Loads the library libplumbline_opencv.so at the first call, from where it was built or was
// installed beside the program. Throws InputError where it cannot be loaded. May be called by
// several threads.
const OpenCvModules& LoadOpenCvModules();

}  // namespace plumbline
