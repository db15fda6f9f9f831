// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/sample_image.h"

#include "plumbline/image/image_codecs.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/io/export/png.h"

#include <algorithm>
#include <cstdint>

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

// The left image, dark where the mask of the frame leaves it out.
GrayImage WithMask(const RectifiedFrame& images) {
  GrayImage shown = images.left;
  const GrayImage& mask = images.left_mask;
  if (mask.width() != shown.width() || mask.height() != shown.height()) return shown;
  const auto dark = [](std::uint8_t level, std::uint8_t used) {
    return static_cast<std::uint8_t>(used != 0 ? level : level / 4);
  };
  const std::int64_t pixels = std::int64_t{shown.width()} * shown.height();
  std::transform(shown.data(), shown.data() + pixels, mask.data(), shown.data(), dark);
  return shown;
}

constexpr Color kMatchedPoint{0, 230, 0};
constexpr Color kFreePoint{150, 150, 150};
constexpr Color kMatchedLine{255, 140, 0};
constexpr Color kFreeLine{70, 130, 255};

}  // namespace

SampleImage MakeSampleImage(const FrameView& view, const std::string& file) {
  SampleImage sample;
  sample.frame = view.frame.id;
  sample.file = file;
  sample.width = view.images.left.width();
  sample.height = view.images.left.height();
  sample.jpeg = SmallJpegOf(WithMask(view.images));
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

void WriteFeatureOverlay(const FrameView& view, const std::filesystem::path& path) {
  const Features features = MeasuredFeatures(*view.frame.indexed);
  Overlay overlay;
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    const bool matched = view.frame.points[i].valid();
    overlay.points.push_back({features.points[i].px, matched ? kMatchedPoint : kFreePoint});
  }
  for (std::size_t i = 0; i < features.lines.size(); ++i) {
    const bool matched = view.frame.lines[i].valid();
    overlay.segments.push_back({features.lines[i].segment, matched ? kMatchedLine : kFreeLine});
  }
  WriteOverlayPng(path, WithMask(view.images), overlay);
}

}  // namespace plumbline
