// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/match_lines.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/units.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// Returns true if both are pieces of one edge, so that neither may spoil the ratio test of the
// other.
bool Collinear(const Segment2& a, const Segment2& b) {
  constexpr double kMaxOffsetPx = 3;
  constexpr double kMinCosine = 0.998;
  if (std::abs(a.Direction().dot(b.Direction())) < kMinCosine) return false;
  return std::abs(LineDistance(LineThrough(a), b.Midpoint())) < kMaxOffsetPx;
}

// The numbers of a segment that the comparison of places needs, computed once for all its pairs.
struct Place {
  double length;
  Eigen::Vector2d direction, midpoint;
  Eigen::Vector3d line;

  explicit Place(const Segment2& s)
      : length(s.Length()),
        direction(s.Direction()),
        midpoint(s.Midpoint()),
        line(LineThrough(s)) {}
};

bool PlacesCompatible(const Place& a,
                      const Place& b,
                      double min_cosine,
                      const LineMatchOptions& options) {
  if (!(a.length > 0) || !(b.length > 0)) return false;
  if (a.direction.dot(b.direction) < min_cosine) return false;
  if (std::min(a.length, b.length) < options.min_length_ratio * std::max(a.length, b.length)) {
    return false;
  }
  if (std::abs(LineDistance(a.line, b.midpoint)) > options.max_offset_px ||
      std::abs(LineDistance(b.line, a.midpoint)) > options.max_offset_px) {
    return false;
  }
  if (options.max_shift_px <= 0) return true;
  return (a.midpoint - b.midpoint).norm() - 0.5 * (a.length + b.length) <= options.max_shift_px;
}

double MinCosine(const LineMatchOptions& options) {
  return math::Cos(options.max_angle_deg * kDegree);
}

struct Pairing {
  int max_distance = 256;
  double ratio = 1;
  bool mutual = true;
};

// Finds the best match of each row of a table of distances (`none` for pairs that are not allowed),
// with ratio and mutual tests.
class DistanceTable {
 public:
  DistanceTable(std::size_t rows, std::size_t columns)
      : rows_(rows), columns_(columns), distance_(rows * columns, kNone), best_row_(columns, -1) {}

  // Sets a distance. To be called row by row, each in the order of the columns.
  void Set(std::size_t row, std::size_t column, int distance) {
    distance_[row * columns_ + column] = distance;
    int& best = best_row_[column];
    if (best < 0 || distance < At(static_cast<std::size_t>(best), column)) {
      best = static_cast<int>(row);
    }
  }

  std::vector<FeatureMatch> Match(const std::vector<LineFeature>& b, const Pairing& pairing) const {
    std::vector<FeatureMatch> matches;
    std::vector<int> owner(columns_, -1);
    for (std::size_t row = 0; row < rows_; ++row) {
      const int column = BestColumn(row);
      if (column < 0) continue;
      const auto c = static_cast<std::size_t>(column);
      const int distance = At(row, c);
      if (distance > pairing.max_distance || Ambiguous(row, c, b, pairing.ratio)) continue;
      if (pairing.mutual && best_row_[c] != static_cast<int>(row)) continue;
      if (owner[c] >= 0) {  // possible only without the mutual test
        FeatureMatch& earlier = matches[static_cast<std::size_t>(owner[c])];
        if (distance >= earlier.distance) continue;
        earlier.a = -1;
      }
      owner[c] = static_cast<int>(matches.size());
      matches.push_back({static_cast<int>(row), column, distance});
    }
    std::erase_if(matches, [](const FeatureMatch& m) { return m.a < 0; });
    return matches;
  }

 private:
  static constexpr int kNone = 1000;

  int At(std::size_t row, std::size_t column) const { return distance_[row * columns_ + column]; }

  int BestColumn(std::size_t row) const {
    int best = -1;
    int distance = kNone;
    for (std::size_t column = 0; column < columns_; ++column) {
      if (At(row, column) >= distance) continue;
      distance = At(row, column);
      best = static_cast<int>(column);
    }
    return best;
  }

  bool Ambiguous(std::size_t row,
                 std::size_t best,
                 const std::vector<LineFeature>& b,
                 double ratio) const {
    if (ratio >= 1) return false;
    for (std::size_t column = 0; column < columns_; ++column) {
      if (column == best || At(row, column) == kNone) continue;
      if (At(row, best) < ratio * At(row, column)) continue;
      if (!Collinear(b[best].segment, b[column].segment)) return true;
    }
    return false;
  }

  std::size_t rows_;
  std::size_t columns_;
  std::vector<int> distance_;
  std::vector<int> best_row_;  // best row of each column; of equal ones the first
};

// Limits of a match between left and right image. Descriptors may differ as much as between two
// frames, directions more: the second viewpoint turns near lines.
constexpr int kMaxDistance = LineMatchOptions{}.max_distance;
constexpr double kRatio = LineMatchOptions{}.ratio;
constexpr double kMaxAngleDeg = 30;
// Least common rows (columns for flat lines) / rows of the shorter line: the detector finds other
// pieces of an edge in each image.
constexpr double kLeastOverlap = 0.5;
// Largest distance of flat lines across the rows: errors of rectification and of both lines.
constexpr double kMaxRowErrorPx = 2;

// The numbers of a line that matching left and right lines needs repeatedly.
struct StereoLine {
  Segment2 segment;
  Eigen::Vector2d direction;
  double row_sine;  // sine of its angle with the rows

  explicit StereoLine(const Segment2& s)
      : segment(s), direction(s.Direction()), row_sine(std::abs(direction.y())) {}
};

std::vector<StereoLine> StereoLines(const std::vector<LineFeature>& lines) {
  std::vector<StereoLine> result;
  result.reserve(lines.size());
  for (const LineFeature& line : lines) result.emplace_back(line.segment);
  return result;
}

double FlatSine(double flat_angle_deg) { return math::Sin(flat_angle_deg * kDegree); }

double RowSine(const Segment2& segment) { return std::abs(segment.Direction().y()); }

// Returns x of the infinite line through the segment at a row.
double XAtRow(const Segment2& segment, double row) {
  const Eigen::Vector2d d = segment.end - segment.start;
  return segment.start.x() + (row - segment.start.y()) / d.y() * d.x();
}

// Returns the length of the common part of two intervals, over that of the shorter one.
double IntervalOverlap(double a0, double a1, double b0, double b1) {
  if (a0 > a1) std::swap(a0, a1);
  if (b0 > b1) std::swap(b0, b1);
  const double shorter = std::min(a1 - a0, b1 - b0);
  if (shorter <= 0) return 0;
  return std::max(0.0, std::min(a1, b1) - std::max(a0, b0)) / shorter;
}

bool SteepCompatible(const Segment2& left, const Segment2& right, double max_disparity) {
  if (IntervalOverlap(left.start.y(), left.end.y(), right.start.y(), right.end.y()) <
      kLeastOverlap) {
    return false;
  }
  const double top =
      std::max(std::min(left.start.y(), left.end.y()), std::min(right.start.y(), right.end.y()));
  const double bottom =
      std::min(std::max(left.start.y(), left.end.y()), std::max(right.start.y(), right.end.y()));
  constexpr double kNoisePx = 1;
  for (const double row : {top, bottom}) {
    const double disparity = XAtRow(left, row) - XAtRow(right, row);
    if (disparity < -kNoisePx || disparity > max_disparity) return false;
  }
  return true;
}

// Returns true if some disparity of the allowed range brings one line onto the other.
bool FlatCompatible(const Segment2& left, const Segment2& right, double max_disparity) {
  const double shift = std::clamp(left.Midpoint().x() - right.Midpoint().x(), 0.0, max_disparity);
  if (IntervalOverlap(
          left.start.x(), left.end.x(), right.start.x() + shift, right.end.x() + shift) <
      kLeastOverlap) {
    return false;
  }
  const Eigen::Vector3d line = LineThrough(left);
  const double near = LineDistance(line, right.Midpoint());
  const double far = near + line.x() * max_disparity;
  return std::min(near, far) <= kMaxRowErrorPx && std::max(near, far) >= -kMaxRowErrorPx;
}

}  // namespace

bool LinesCompatible(const Segment2& a, const Segment2& b, const LineMatchOptions& options) {
  return PlacesCompatible(Place(a), Place(b), MinCosine(options), options);
}

std::vector<FeatureMatch> MatchLines(const std::vector<LineFeature>& a,
                                     const std::vector<LineFeature>& b,
                                     const LineMatchOptions& options) {
  const double min_cosine = MinCosine(options);
  std::vector<Place> places;
  places.reserve(b.size());
  for (const LineFeature& line : b) places.emplace_back(line.segment);
  DistanceTable table(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Place place(a[i].segment);
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (!PlacesCompatible(place, places[j], min_cosine, options)) continue;
      table.Set(i, j, HammingDistance(a[i].descriptor, b[j].descriptor));
    }
  }
  return table.Match(b, {options.max_distance, options.ratio, options.mutual});
}

std::vector<std::optional<MeasuredSegment>> MatchStereoLines(const RectifiedCamera& camera,
                                                             const std::vector<LineFeature>& left,
                                                             const std::vector<LineFeature>& right,
                                                             const StereoLineOptions& options) {
  PLUMBLINE_CHECK(camera.baseline > 0, "stereo needs a baseline");
  const double max_disparity = camera.DisparityFromDepth(options.min_depth_m);
  const double min_cosine = math::Cos(kMaxAngleDeg * kDegree);
  const double flat = FlatSine(kFlatAngleDeg);
  const std::vector<StereoLine> left_lines = StereoLines(left);
  const std::vector<StereoLine> right_lines = StereoLines(right);
  DistanceTable table(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const StereoLine& l = left_lines[i];
    for (std::size_t j = 0; j < right.size(); ++j) {
      const StereoLine& r = right_lines[j];
      if (l.direction.dot(r.direction) < min_cosine) continue;
      const bool compatible = std::min(l.row_sine, r.row_sine) < flat
                                  ? FlatCompatible(l.segment, r.segment, max_disparity)
                                  : SteepCompatible(l.segment, r.segment, max_disparity);
      if (compatible) table.Set(i, j, HammingDistance(left[i].descriptor, right[j].descriptor));
    }
  }
  const double calibration_sigma_px = options.calibration_sigma * camera.width;
  std::vector<std::optional<MeasuredSegment>> result(left.size());
  for (const FeatureMatch& m : table.Match(right, {kMaxDistance, kRatio, true})) {
    const LineFeature& r = right[static_cast<std::size_t>(m.b)];
    // An error of the calibration shifts the line along the rows, and by this much across itself.
    const double shift = calibration_sigma_px * std::abs(r.segment.Direction().y());
    result[static_cast<std::size_t>(m.a)] =
        MeasuredSegment{r.segment, math::Hypot(r.sigma_px, shift)};
  }
  return result;
}

std::optional<LineEndDisparity> LineEndDisparities(const LineFeature& left,
                                                   const MeasuredSegment& right,
                                                   double flat_angle_deg) {
  const double left_sine = RowSine(left.segment);
  const double right_sine = RowSine(right.segment);
  if (!(std::min(left_sine, right_sine) >= FlatSine(flat_angle_deg)) || !(right_sine > 0)) {
    return std::nullopt;
  }
  const double height = right.segment.end.y() - right.segment.start.y();
  const auto at = [&](const Eigen::Vector2d& end) {
    // The noise of the right line between and beyond its ends, whose errors are independent.
    const double t = (end.y() - right.segment.start.y()) / height;
    const double across = right.sigma_px * std::sqrt((1 - t) * (1 - t) + t * t);
    return Disparity{end.x() - XAtRow(right.segment, end.y()),
                     math::Hypot(left.sigma_px / left_sine, across / right_sine)};
  };
  const LineEndDisparity result{at(left.segment.start), at(left.segment.end)};
  if (result.start.px <= 0 || result.end.px <= 0) return std::nullopt;
  return result;
}

std::vector<RemovedOption> RemovedOptions(std::type_identity<StereoLineOptions> /*of*/) {
  return {FixedAt("max_distance", kMaxDistance, "LineMatchOptions::max_distance"),
          FixedAt("ratio", kRatio, "LineMatchOptions::ratio"),
          FixedAt("max_angle_deg", kMaxAngleDeg, "kMaxAngleDeg"),
          FixedAt("min_overlap", kLeastOverlap, "kLeastOverlap"),
          FixedAt("flat_angle_deg", kFlatAngleDeg, "kFlatAngleDeg"),
          FixedAt("max_row_error_px", kMaxRowErrorPx, "kMaxRowErrorPx")};
}

}  // namespace plumbline
