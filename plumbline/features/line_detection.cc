// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_detection.h"

#include "plumbline/features/line_refinement.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_drawing.hpp>

namespace plumbline {
namespace {

constexpr double kBorderPx = 3;
constexpr double kDegree = std::numbers::pi / 180;

std::vector<Segment2> RawSegments(const GrayImage& image,
                                  LineDetector detector,
                                  const LineDetectionOptions& options) {
  std::vector<cv::Vec4f> lines;
  if (detector == LineDetector::kLsd) {
    const auto lsd = cv::createLineSegmentDetector(cv::LSD_REFINE_NONE, options.lsd_scale);
    lsd->detect(AsMat(image), lines);
  } else {
    const auto drawing = cv::ximgproc::createEdgeDrawing();
    drawing->detectEdges(AsMat(image));
    drawing->detectLines(lines);
  }
  std::vector<Segment2> segments;
  segments.reserve(lines.size());
  for (const cv::Vec4f& l : lines) {
    Segment2 segment{{static_cast<double>(l[0]), static_cast<double>(l[1])},
                     {static_cast<double>(l[2]), static_cast<double>(l[3])}};
    if (detector == LineDetector::kLsd) {
      // LSD gives (x + 1/2) / scale for the meeting point of four pixels of its smaller image,
      // whose place in the full image is (x + 1) / scale - 1/2.
      const double shift = 0.5 / options.lsd_scale - 0.5;
      segment.start.array() += shift;
      segment.end.array() += shift;
    }
    segments.push_back(segment);
  }
  return segments;
}

// The longest part of the segment that keeps its distance from invalid pixels.
std::optional<Segment2> ClipToValid(const Segment2& segment, const ValidRegion& valid) {
  const int steps = std::max(1, static_cast<int>(std::ceil(segment.Length())));
  const auto at = [&](int i) -> Eigen::Vector2d {
    return segment.start + static_cast<double>(i) / steps * (segment.end - segment.start);
  };
  int best_begin = 0;
  int best_end = -1;
  int begin = 0;
  for (int i = 0; i <= steps; ++i) {
    if (!valid.Contains(at(i), kBorderPx)) {
      begin = i + 1;
    } else if (i - begin > best_end - best_begin) {
      best_begin = begin;
      best_end = i;
    }
  }
  if (best_end <= best_begin) return std::nullopt;
  return Segment2{at(best_begin), at(best_end)};
}

// Directed, moved onto the edge; nullopt when too weak, too short or not an edge.
std::optional<LineFeature> MakeLine(const GradientImage& gradient,
                                    const Segment2& segment,
                                    double min_length,
                                    const LineDetectionOptions& options) {
  if (segment.Length() < min_length) return std::nullopt;
  LineFeature line;
  line.segment = MeanNormalGradient(gradient, segment) > 0 ? segment.Reversed() : segment;
  line.sigma_px = std::max(options.min_sigma_px, 1.0);
  if (options.refine) {
    // Twice: the first fit may have looked along a normal that is a few degrees off.
    for (const int range : {3, 2}) {
      const std::optional<RefinedSegment> refined = RefineSegment(gradient, line.segment, range);
      if (!refined) return std::nullopt;
      line.segment = refined->segment;
      line.sigma_px = std::max(options.min_sigma_px, refined->sigma_px);
    }
  }
  line.response = -MeanNormalGradient(gradient, line.segment);
  if (line.response < options.min_contrast) return std::nullopt;
  return line;
}

// The segment that covers both when b continues (or overlaps) a on the same straight edge.
std::optional<Segment2> Join(const GradientImage& gradient,
                             const LineFeature& a,
                             const LineFeature& b,
                             const LineDetectionOptions& options) {
  const Eigen::Vector2d direction = a.segment.Direction();
  if (direction.dot(b.segment.Direction()) < std::cos(options.merge_angle_deg * kDegree)) {
    return std::nullopt;
  }
  const Eigen::Vector3d line = LineThrough(a.segment);
  if (std::abs(LineDistance(line, b.segment.start)) > options.merge_offset_px ||
      std::abs(LineDistance(line, b.segment.end)) > options.merge_offset_px) {
    return std::nullopt;
  }
  const double a_length = a.segment.Length();
  const double b0 = direction.dot(b.segment.start - a.segment.start);
  const double b1 = direction.dot(b.segment.end - a.segment.start);
  const double gap = std::max(b0 - a_length, -b1);
  if (gap > options.merge_gap * std::min(a_length, b.segment.Length())) return std::nullopt;
  if (gap > 2) {  // the edge must be there in the gap too
    const Segment2 between = b0 > a_length ? Segment2{a.segment.end, b.segment.start}
                                           : Segment2{b.segment.end, a.segment.start};
    if (-MeanNormalGradient(gradient, between) < 0.4 * std::min(a.response, b.response)) {
      return std::nullopt;
    }
  }
  return Segment2{b0 < 0 ? b.segment.start : a.segment.start,
                  b1 > a_length ? b.segment.end : a.segment.end};
}

// Joins pieces to the longest segment they continue until nothing changes. `lines` longest first.
std::vector<LineFeature> MergeLines(const GradientImage& gradient,
                                    std::vector<LineFeature> lines,
                                    const LineDetectionOptions& options) {
  std::vector<bool> used(lines.size(), false);
  std::vector<LineFeature> merged;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (used[i]) continue;
    LineFeature line = lines[i];
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t j = i + 1; j < lines.size(); ++j) {
        if (used[j]) continue;
        const std::optional<Segment2> joined = Join(gradient, line, lines[j], options);
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

// The best by length times contrast, each worth less the more better ones its cell has.
std::vector<LineFeature> SelectLines(const std::vector<LineFeature>& lines,
                                     int width,
                                     int height,
                                     std::size_t count) {
  if (lines.size() <= count) return lines;
  constexpr int kColumns = 6;
  constexpr int kRows = 4;
  std::vector<double> score(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    score[i] = lines[i].segment.Length() * std::sqrt(lines[i].response);
  }
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0);
  const auto by_score = [&](std::size_t a, std::size_t b) { return score[a] > score[b]; };
  std::stable_sort(order.begin(), order.end(), by_score);
  std::array<int, static_cast<std::size_t>(kColumns * kRows)> taken{};
  for (const std::size_t i : order) {
    const Eigen::Vector2d middle = lines[i].segment.Midpoint();
    const int x = std::clamp(static_cast<int>(middle.x() * kColumns / width), 0, kColumns - 1);
    const int y = std::clamp(static_cast<int>(middle.y() * kRows / height), 0, kRows - 1);
    int& rank = taken[static_cast<std::size_t>(y * kColumns + x)];
    score[i] /= 1 + rank * static_cast<double>(kColumns * kRows) / static_cast<double>(count);
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

double MeanNormalGradient(const GradientImage& gradient, const Segment2& segment) {
  const double length = segment.Length();
  if (!(length > 0)) return 0;
  const Eigen::Vector2d direction = segment.Direction();
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  const int samples = std::clamp(static_cast<int>(length / 2), 4, 64);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < samples; ++i) {
    sum += GradientAt(gradient, segment.start + (i + 0.5) / samples * length * direction);
  }
  return normal.dot(sum) / samples;
}

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
  // Pieces may be shorter when they can still be joined.
  const double min_piece = options.merge ? 0.6 * min_length : min_length;
  std::vector<LineFeature> lines;
  for (const Segment2& raw : RawSegments(image, detector, options)) {
    if (raw.Length() < min_piece) continue;
    const std::optional<Segment2> clipped = ClipToValid(raw, valid);
    if (!clipped) continue;
    const std::optional<LineFeature> line = MakeLine(gradient, *clipped, min_piece, options);
    if (line) lines.push_back(*line);
  }
  SortByLength(&lines);
  if (options.merge) {
    lines = MergeLines(gradient, std::move(lines), options);
    SortByLength(&lines);
  }
  std::erase_if(lines, [&](const LineFeature& l) { return l.segment.Length() < min_length; });
  return SelectLines(lines, image.width(), image.height(), static_cast<std::size_t>(count));
}

}  // namespace plumbline
