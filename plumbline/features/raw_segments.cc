// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/raw_segments.h"

#include "plumbline/features/segment_drawing.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/opencv_modules.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

GrayImage Resized(const GrayImage& image, double scale) {
  GrayImage small(std::max(1, static_cast<int>(std::lround(image.width() * scale))),
                  std::max(1, static_cast<int>(std::lround(image.height() * scale))));
  cv::Mat target = AsMat(small);
  cv::resize(
      AsMat(image), target, target.size(), 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  return small;
}

std::vector<Segment2> ToSegments(const std::vector<cv::Vec4f>& lines) {
  std::vector<Segment2> segments;
  segments.reserve(lines.size());
  for (const cv::Vec4f& l : lines) {
    segments.push_back({{static_cast<double>(l[0]), static_cast<double>(l[1])},
                        {static_cast<double>(l[2]), static_cast<double>(l[3])}});
  }
  return segments;
}

std::vector<Segment2> Lsd(const GrayImage& image, double scale) {
  std::vector<cv::Vec4f> lines;
  cv::createLineSegmentDetector(cv::LSD_REFINE_NONE, scale)->detect(AsMat(image), lines);
  std::vector<Segment2> segments = ToSegments(lines);
  // LSD returns (x + 1/2) / scale for the meeting point of four pixels of its smaller image, whose
  // place in the full image is (x + 1) / scale - 1/2.
  const double shift = 0.5 / scale - 0.5;
  for (Segment2& segment : segments) {
    segment.start.array() += shift;
    segment.end.array() += shift;
  }
  return segments;
}

std::vector<Segment2> EdLines(const GrayImage& image) {
  return ToSegments(LoadOpenCvModules().EdgeDrawingLines(AsMat(image)));
}

}  // namespace

std::vector<Segment2> FindRawSegments(const GrayImage& image,
                                      const GradientImage& gradient,
                                      const RawSegmentOptions& options) {
  if (options.detector == LineDetector::kLsd) return Lsd(image, options.scale);
  // Single pixels may be weaker than the mean over the line, which the contrast limits.
  const SegmentDrawingLimits limits{options.min_length * options.scale,
                                    2.0 / 3 * options.min_contrast};
  if (options.scale == 1) {
    return options.detector == LineDetector::kEdlines ? EdLines(image)
                                                      : DrawSegments(gradient, limits);
  }
  constexpr int kMinSide = 16;
  const GrayImage small = Resized(image, options.scale);
  if (std::min(small.width(), small.height()) < kMinSide) return {};
  std::vector<Segment2> segments = options.detector == LineDetector::kEdlines
                                       ? EdLines(small)
                                       : DrawSegments(ComputeGradient(small, 0.7), limits);
  const Eigen::Array2d ratio(static_cast<double>(image.width()) / small.width(),
                             static_cast<double>(image.height()) / small.height());
  for (Segment2& s : segments) {
    for (Eigen::Vector2d* end : {&s.start, &s.end}) {
      *end = (end->array() + 0.5) * ratio - 0.5;
    }
  }
  return segments;
}

}  // namespace plumbline
