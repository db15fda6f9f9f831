// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_detection.h"

#include "plumbline/features/line_refinement.h"
#include "plumbline/features/segment_drawing.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/opencv_modules.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

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
  const double min_length = options.min_length * options.scale;
  const double min_gradient = 2.0 / 3 * options.min_contrast;
  if (options.scale == 1) {
    return options.detector == LineDetector::kEdlines
               ? EdLines(image)
               : DrawSegments(gradient, min_length, min_gradient);
  }
  constexpr int kMinSide = 16;
  const GrayImage small = Resized(image, options.scale);
  if (std::min(small.width(), small.height()) < kMinSide) return {};
  std::vector<Segment2> segments =
      options.detector == LineDetector::kEdlines
          ? EdLines(small)
          : DrawSegments(ComputeGradient(small, 0.7), min_length, min_gradient);
  const Eigen::Array2d ratio(static_cast<double>(image.width()) / small.width(),
                             static_cast<double>(image.height()) / small.height());
  for (Segment2& s : segments) {
    for (Eigen::Vector2d* end : {&s.start, &s.end}) {
      *end = (end->array() + 0.5) * ratio - 0.5;
    }
  }
  return segments;
}

namespace {

constexpr double kBorderPx = 3;
constexpr double kSettledPx = 0.5;

// Returns the longest part of the segment that keeps its distance from invalid pixels.
std::optional<Segment2> ClipToValid(const Segment2& segment, const ValidRegion& valid) {
  const auto at = [&](int i, int steps) -> Eigen::Vector2d {
    return segment.start + static_cast<double>(i) / steps * (segment.end - segment.start);
  };
  const double length = segment.Length();
  // Most segments lie well inside, which a test every few pixels shows.
  const int looks = 1 + static_cast<int>(length / (2 * kBorderPx));
  int inside = 0;
  while (inside <= looks && valid.Contains(at(inside, looks), kBorderPx)) ++inside;
  if (inside > looks) return segment;
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  int best_begin = 0;
  int best_end = -1;
  int begin = 0;
  for (int i = 0; i <= steps; ++i) {
    if (!valid.Contains(at(i, steps), kBorderPx)) {
      begin = i + 1;
    } else if (i - begin > best_end - best_begin) {
      best_begin = begin;
      best_end = i;
    }
  }
  if (best_end <= best_begin) return std::nullopt;
  return Segment2{at(best_begin, steps), at(best_end, steps)};
}

// Returns the segment as a directed line, moved onto the edge; nullopt when it is too weak, too
// short or not an edge.
std::optional<LineFeature> MakeLine(const GradientImage& gradient,
                                    const Segment2& segment,
                                    double min_length,
                                    const LineDetectionOptions& options) {
  if (segment.Length() < min_length) return std::nullopt;
  LineFeature line;
  line.segment = MeanNormalGradient(gradient, segment) > 0 ? segment.Reversed() : segment;
  line.sigma_px = std::max(kLeastLineSigmaPx, 1.0);
  if (options.refine) {
    // The fit is repeated, because the first one looked along a normal that was a few degrees off.
    for (const int range : {3, 2}) {
      const std::optional<MeasuredSegment> refined = RefineSegment(gradient, line.segment, range);
      if (!refined) return std::nullopt;
      const double moved = std::max((refined->segment.start - line.segment.start).norm(),
                                    (refined->segment.end - line.segment.end).norm());
      line.segment = refined->segment;
      line.sigma_px = std::max(kLeastLineSigmaPx, refined->sigma_px);
      if (moved < kSettledPx) break;
    }
  }
  line.response = -MeanNormalGradient(gradient, line.segment);
  if (line.response < RawSegmentOptions{}.min_contrast) return std::nullopt;
  return line;
}

// The defaults, which are narrow: pieces of two edges that are joined make a line that is none.
constexpr LineMergeLimits kMergeLimits;

// Joins one collinear neighbour after the other to the longest segment that it continues, if the
// result is still an edge. `lines` must be ordered with the longest first.
std::vector<LineFeature> MergeLines(const GradientImage& gradient,
                                    const std::vector<LineFeature>& lines,
                                    const LineDetectionOptions& options) {
  const CollinearIndex index(lines);
  std::vector<bool> used(lines.size(), false);
  std::vector<LineFeature> merged;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (used[i]) continue;
    LineFeature line = lines[i];
    used[i] = true;
    for (bool grown = true; grown;) {
      grown = false;
      for (const std::size_t j : index.Near(line.segment, kMergeLimits)) {
        if (used[j]) continue;
        const std::optional<Segment2> joined = Join(gradient, line, lines[j], kMergeLimits);
        if (!joined) continue;
        const std::optional<LineFeature> candidate = MakeLine(gradient, *joined, 0, options);
        if (!candidate) continue;
        line = *candidate;
        used[j] = true;
        grown = true;
      }
    }
    merged.push_back(line);
  }
  return merged;
}

void SortByLength(std::vector<LineFeature>* lines) {
  std::stable_sort(lines->begin(), lines->end(), [](const LineFeature& a, const LineFeature& b) {
    return a.segment.Length() > b.segment.Length();
  });
}

// Returns the best lines by length times contrast. Each is worth less, the more better lines its
// cell has.
std::vector<LineFeature> SelectLines(const std::vector<LineFeature>& lines,
                                     int width,
                                     int height,
                                     std::size_t count) {
  if (lines.size() <= count) return lines;
  constexpr int kCellColumns = 6;
  constexpr int kCellRows = 4;
  std::vector<double> score(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    score[i] = lines[i].segment.Length() * std::sqrt(lines[i].response);
  }
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0);
  const auto by_score = [&](std::size_t a, std::size_t b) { return score[a] > score[b]; };
  std::stable_sort(order.begin(), order.end(), by_score);
  std::array<int, static_cast<std::size_t>(kCellColumns * kCellRows)> taken{};
  for (const std::size_t i : order) {
    const Eigen::Vector2d middle = lines[i].segment.Midpoint();
    const int x =
        std::clamp(static_cast<int>(middle.x() * kCellColumns / width), 0, kCellColumns - 1);
    const int y = std::clamp(static_cast<int>(middle.y() * kCellRows / height), 0, kCellRows - 1);
    int& rank = taken[static_cast<std::size_t>(y * kCellColumns + x)];
    score[i] /=
        1 + rank * static_cast<double>(kCellColumns * kCellRows) / static_cast<double>(count);
    ++rank;
  }
  std::stable_sort(order.begin(), order.end(), by_score);
  order.resize(count);
  std::vector<LineFeature> selected;
  selected.reserve(count);
  for (const std::size_t i : order) selected.push_back(lines[i]);
  return selected;
}

}  // namespace

std::vector<LineFeature> DetectLines(const GrayImage& image,
                                     const GradientImage& gradient,
                                     const ValidRegion& valid,
                                     LineDetector detector,
                                     int count,
                                     const LineDetectionOptions& options) {
  constexpr int kMinSide = 16;
  if (count <= 0 || std::min(image.width(), image.height()) < kMinSide) return {};
  PLUMBLINE_CHECK(gradient.width() == image.width() && gradient.height() == image.height(),
                  "gradient of the same image");
  const double min_length = options.min_length * std::max(image.width(), image.height());
  // Pieces may be shorter when they can still be joined. Drawing jumps small gaps by itself.
  const bool pieces = options.merge && detector != LineDetector::kDrawing;
  const double min_piece = pieces ? 0.6 * min_length : min_length;
  const RawSegmentOptions raw_options{detector, options.detection_scale, min_piece};
  std::vector<LineFeature> lines;
  for (const Segment2& raw : FindRawSegments(image, gradient, raw_options)) {
    if (raw.Length() < min_piece) continue;
    const std::optional<Segment2> clipped = ClipToValid(raw, valid);
    if (!clipped) continue;
    const std::optional<LineFeature> line = MakeLine(gradient, *clipped, min_piece, options);
    if (line) lines.push_back(*line);
  }
  SortByLength(&lines);
  if (options.merge) {
    lines = MergeLines(gradient, lines, options);
    SortByLength(&lines);
  }
  std::erase_if(lines, [&](const LineFeature& l) { return l.segment.Length() < min_length; });
  return SelectLines(lines, image.width(), image.height(), static_cast<std::size_t>(count));
}

std::vector<RemovedOption> RemovedOptions(std::type_identity<LineDetectionOptions> /*of*/) {
  return {
      FixedAt("merge_angle_deg", kMergeLimits.angle_deg, "LineMergeLimits::angle_deg"),
      FixedAt("merge_offset_px", kMergeLimits.offset_px, "LineMergeLimits::offset_px"),
      FixedAt("merge_gap", kMergeLimits.gap, "LineMergeLimits::gap"),
      FixedAt("min_contrast", RawSegmentOptions{}.min_contrast, "RawSegmentOptions::min_contrast"),
      FixedAt("min_sigma_px", kLeastLineSigmaPx, "kLeastLineSigmaPx")};
}

}  // namespace plumbline
