// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/sample_image.h"

#include "plumbline/image/image_codecs.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

constexpr int kMaxWidth = 1280;
constexpr int kJpegQuality = 80;

std::string SmallJpegOf(const GrayImage& image) {
  cv::Mat pixels = AsMat(image);
  const double scale = std::min(static_cast<double>(kMaxWidth) / pixels.cols,
                                static_cast<double>(kLongestJpegSide) / pixels.rows);
  if (scale < 1) {
    // A very flat image keeps one row.
    const bool flat = cvRound(scale * pixels.rows) == 0;
    cv::Mat smaller;
    cv::resize(
        pixels, smaller, flat ? cv::Size(kMaxWidth, 1) : cv::Size(), scale, scale, cv::INTER_AREA);
    pixels = smaller;
  }
  return EncodeJpeg(pixels, kJpegQuality);
}

}  // namespace

SampleImage MakeSampleImage(const FrameView& view, const std::string& file) {
  SampleImage sample;
  sample.frame = view.frame.id;
  sample.file = file;
  sample.width = view.images.left.width();
  sample.height = view.images.left.height();
  sample.jpeg = SmallJpegOf(view.images.left);
  const Features features = MeasuredFeatures(*view.frame.indexed);
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    const bool matched = view.frame.points[i].valid();
    (matched ? sample.matched_points : sample.other_points).push_back(features.points[i].px);
  }
  for (std::size_t i = 0; i < features.lines.size(); ++i) {
    const bool matched = view.frame.lines[i].valid();
    (matched ? sample.matched_lines : sample.other_lines).push_back(features.lines[i].segment);
  }
  return sample;
}

}  // namespace plumbline
