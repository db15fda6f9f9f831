// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/png.h"

#include "plumbline/base/error.h"
#include "plumbline/image/image_codecs.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/io/atomic_file.h"

#include <array>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

// OpenCV draws with fixed-point coordinates; 4 fractional bits.
constexpr int kShift = 4;

cv::Point FixedPoint(const Eigen::Vector2d& px) {
  const double scale = 1 << kShift;
  return {static_cast<int>(std::lround(px.x() * scale)),
          static_cast<int>(std::lround(px.y() * scale))};
}

cv::Scalar Bgr(const Color& color) { return {double(color.b), double(color.g), double(color.r)}; }

bool Drawable(const Eigen::Vector2d& px) {
  return px.allFinite() && px.cwiseAbs().maxCoeff() < 1e6;
}

}  // namespace

std::string EncodeOverlayPng(const GrayImage& image, const Overlay& overlay) {
  PLUMBLINE_CHECK(!image.empty(), "an image without pixels");
  cv::Mat canvas;
  cv::cvtColor(AsMat(image), canvas, cv::COLOR_GRAY2BGR);
  for (const OverlaySegment& drawn : overlay.segments) {
    if (!Drawable(drawn.segment.start) || !Drawable(drawn.segment.end)) continue;
    cv::line(canvas,
             FixedPoint(drawn.segment.start),
             FixedPoint(drawn.segment.end),
             Bgr(drawn.color),
             1,
             cv::LINE_AA,
             kShift);
  }
  for (const OverlayPoint& drawn : overlay.points) {
    if (!Drawable(drawn.px)) continue;
    const int radius = 2 << kShift;
    cv::circle(canvas, FixedPoint(drawn.px), radius, Bgr(drawn.color), 1, cv::LINE_AA, kShift);
  }
  return EncodePng(canvas);
}

void WriteGrayPng(const std::filesystem::path& path, const GrayImage& image) {
  PLUMBLINE_CHECK(!image.empty(), "an image without pixels");
  WriteFileAtomically(path, EncodePng(AsMat(image)));
}

void WriteColorPng(const std::filesystem::path& path, const ColorImage& image) {
  if (IsGray(image)) return WriteGrayPng(path, image.red);
  const std::array<cv::Mat, 3> channels = {AsMat(image.blue), AsMat(image.green), AsMat(image.red)};
  cv::Mat merged;
  cv::merge(channels.data(), channels.size(), merged);
  WriteFileAtomically(path, EncodePng(merged));
}

void WriteDepthPng(const std::filesystem::path& path, const DepthImage& depth, double factor) {
  PLUMBLINE_CHECK(!depth.empty(), "an image without pixels");
  constexpr double kLargest = 65'535;
  cv::Mat_<std::uint16_t> values(depth.height(), depth.width());
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const double value = std::round(factor * static_cast<double>(depth.at(x, y)));
      values(y, x) = value >= 0 && value <= kLargest ? static_cast<std::uint16_t>(value) : 0;
    }
  }
  WriteFileAtomically(path, EncodePng(values));
}

void WriteOverlayPng(const std::filesystem::path& path,
                     const GrayImage& image,
                     const Overlay& overlay) {
  WriteFileAtomically(path, EncodeOverlayPng(image, overlay));
}

}  // namespace plumbline
