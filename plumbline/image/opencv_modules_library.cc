// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// With video_decoder_library.cc all of libplumbline_opencv.so, which LoadOpenCvModules() loads.
#include "plumbline/image/opencv_modules.h"
#include "plumbline/image/video_decoder_library.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <opencv2/ximgproc/edge_drawing.hpp>

namespace plumbline {
namespace {

class OpenCvVideoCapture : public VideoCapture {
 public:
  bool Open(const std::string& name, int backend, const std::vector<int>& parameters) override {
    return capture_.open(name, backend, parameters);
  }
  bool Open(int device, int backend) override { return capture_.open(device, backend); }
  bool Grab() override { return capture_.grab(); }
  bool Retrieve(cv::Mat& image) override { return capture_.retrieve(image); }
  double Get(int property) const override { return capture_.get(property); }
  void Set(int property, double value) override { capture_.set(property, value); }

 private:
  cv::VideoCapture capture_;
};

class LinkedModules : public OpenCvModules {
 public:
  cv::Mat DecodeImage(std::span<const std::uint8_t> bytes, int flags) const override {
    const cv::Mat row(
        1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<std::uint8_t*>(bytes.data()));
    try {
      return cv::imdecode(row, flags);
    } catch (const cv::Exception&) {
      return {};
    }
  }

  std::unique_ptr<VideoCapture> NewVideoCapture() const override {
    return std::make_unique<OpenCvVideoCapture>();
  }

  std::unique_ptr<VideoDecoder> OpenVideo(const std::string& path) const override {
    return OpenVideoDecoder(path);
  }

  std::vector<cv::Vec4f> EdgeDrawingLines(const cv::Mat& image) const override {
    std::vector<cv::Vec4f> lines;
    const auto drawing = cv::ximgproc::createEdgeDrawing();
    drawing->detectEdges(image);
    drawing->detectLines(lines);
    return lines;
  }
};

}  // namespace
}  // namespace plumbline

// The name is not mangled, so that LoadOpenCvModules() finds it.
extern "C" __attribute__((visibility("default"))) const plumbline::OpenCvModules*
PlumblineOpenCvModules() {
  static const plumbline::LinkedModules modules;
  return &modules;
}
