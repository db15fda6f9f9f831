// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_refinement.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumbline {

namespace {

constexpr std::size_t kMaxSamples = 48;
constexpr std::size_t kMinSamples = 6;
constexpr double kMinInliers = 0.5;

// Edge points found along the segment.
struct EdgePoints {
  std::array<float, kMaxSamples> along;   // distance from the midpoint along the segment, px
  std::array<float, kMaxSamples> across;  // distance from the segment along the normal, px
  std::array<float, kMaxSamples> weight;
  std::size_t size = 0;
};

// Searches the edge along rows or columns of pixels, whichever cross it more squarely, so that the
// gradient is needed only at whole pixels.
class EdgeFinder {
 public:
  EdgeFinder(const GradientImage& gradient, const Segment2& segment, int range_px)
      : gradient_(gradient),
        middle_(segment.Midpoint()),
        direction_(segment.Direction()),
        normal_(-direction_.y(), direction_.x()),
        by_rows_(std::abs(normal_.x()) >= std::abs(normal_.y())),
        range_(std::min(kMaxReach, static_cast<int>(range_px * std::numbers::sqrt2 + 0.5))) {}

  // Returns places of the edge on about `samples` rows (columns) of a segment of this length.
  EdgePoints Find(double length, std::size_t samples) const {
    EdgePoints edges;
    const double major = by_rows_ ? direction_.y() : direction_.x();
    const double middle = by_rows_ ? middle_.y() : middle_.x();
    const double step = length / static_cast<double>(samples);
    double wanted = 0.5 * (step - length);
    for (std::size_t i = 0; i < samples; ++i, wanted += step) {
      const double grid = std::floor(middle + wanted * major + 0.5);
      FindOn(static_cast<int>(grid), (grid - middle) / major, &edges);
    }
    return edges;
  }

 private:
  static constexpr int kMaxReach = 10;

  // Searches the edge on one row (column) of pixels, which the segment's line crosses at `along`.
  void FindOn(int grid, double along, EdgePoints* edges) const {
    const double place =
        by_rows_ ? middle_.x() + along * direction_.x() : middle_.y() + along * direction_.y();
    if (!(std::abs(place) < 1e6)) return;
    const int first = static_cast<int>(std::floor(place + 0.5)) - range_;
    const int limit = by_rows_ ? gradient_.width() : gradient_.height();
    const int other_limit = by_rows_ ? gradient_.height() : gradient_.width();
    if (first < 0 || first + 2 * range_ >= limit || grid < 0 || grid >= other_limit) return;
    const int count = 2 * range_ + 1;
    const std::ptrdiff_t step = by_rows_ ? 1 : gradient_.width();
    const std::ptrdiff_t start = by_rows_ ? gradient_.dx.row(grid) - gradient_.dx.data() + first
                                          : gradient_.dx.row(first) - gradient_.dx.data() + grid;
    const std::int16_t* dx = gradient_.dx.data() + start;
    const std::int16_t* dy = gradient_.dy.data() + start;
    std::array<float, static_cast<std::size_t>(2 * kMaxReach + 1)> slope;
    const auto nx = static_cast<float>(normal_.x() / kSobelGain);
    const auto ny = static_cast<float>(normal_.y() / kSobelGain);
    std::size_t best = 0;
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      slope[i] = -nx * static_cast<float>(dx[k * step]) - ny * static_cast<float>(dy[k * step]);
      if (slope[i] > slope[best]) best = i;
    }
    if (best == 0 || static_cast<int>(best) == count - 1 || slope[best] < 1) return;
    const float curvature = slope[best - 1] - 2 * slope[best] + slope[best + 1];
    if (curvature >= 0) return;
    const float peak = 0.5F * (slope[best - 1] - slope[best + 1]) / curvature;
    const double offset = first + static_cast<int>(best) + static_cast<double>(peak) - place;
    // A step along the row (column) has a component across and one along the segment.
    const std::size_t n = edges->size++;
    edges->along[n] =
        static_cast<float>(along + offset * (by_rows_ ? direction_.x() : direction_.y()));
    edges->across[n] = static_cast<float>(offset * (by_rows_ ? normal_.x() : normal_.y()));
    edges->weight[n] = slope[best];
  }

  const GradientImage& gradient_;
  Eigen::Vector2d middle_;
  Eigen::Vector2d direction_;
  Eigen::Vector2d normal_;
  bool by_rows_;
  int range_;
};

struct LineFit {
  double offset = 0;  // distance across the segment, in its middle
  double slope = 0;
  double scatter = 0;  // robust deviation of the edge points from the line, px
  double inliers = 0;
  double offset_variance = 0;
  double slope_variance = 0;
};

// Returns the line through two of the edge points, one near each end, that has most of the others
// close by.
LineFit FirstGuess(const EdgePoints& edges) {
  constexpr std::size_t kTries = 3;      // number of points at each end
  constexpr float kClose = 0.5F * 0.5F;  // square pixels
  const std::size_t third = edges.size / 3;
  LineFit best;
  float best_cost = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < kTries; ++i) {
    for (std::size_t j = 0; j < kTries; ++j) {
      const std::size_t a = i * third / (kTries - 1);
      const std::size_t b = edges.size - 1 - j * third / (kTries - 1);
      const float width = edges.along[b] - edges.along[a];
      if (std::abs(width) < 1) continue;
      const float slope = (edges.across[b] - edges.across[a]) / width;
      const float offset = edges.across[a] - slope * edges.along[a];
      float cost = 0;
      for (std::size_t k = 0; k < edges.size; ++k) {
        const float r = edges.across[k] - offset - slope * edges.along[k];
        cost += edges.weight[k] * std::min(r * r, kClose);
      }
      if (cost >= best_cost) continue;
      best_cost = cost;
      best.offset = static_cast<double>(offset);
      best.slope = static_cast<double>(slope);
    }
  }
  return best;
}

// Returns the robust deviation of the edge points from the line, from the median of the residuals.
double Scatter(const EdgePoints& edges, const LineFit& fit) {
  std::array<float, kMaxSamples> residuals;
  const auto offset = static_cast<float>(fit.offset);
  const auto slope = static_cast<float>(fit.slope);
  for (std::size_t i = 0; i < edges.size; ++i) {
    residuals[i] = std::abs(edges.across[i] - offset - slope * edges.along[i]);
  }
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(edges.size / 2);
  std::nth_element(
      residuals.begin(), middle, residuals.begin() + static_cast<std::ptrdiff_t>(edges.size));
  return 1.4826 * static_cast<double>(*middle);
}

// Does one weighted fit. Points that are `limit` or more away from the present line do not count.
// Returns false when too few are left.
bool Reweighted(const EdgePoints& edges, double limit, LineFit* fit) {
  double s0 = 0;
  double s1 = 0;
  double s2 = 0;
  double t0 = 0;
  double t1 = 0;
  double squares = 0;
  const double scale = 1 / (limit * limit);
  for (std::size_t i = 0; i < edges.size; ++i) {
    const auto along = static_cast<double>(edges.along[i]);
    const auto across = static_cast<double>(edges.across[i]);
    const double r = across - fit->offset - fit->slope * along;
    const double tukey = std::max(0.0, 1 - r * r * scale);
    const double w = static_cast<double>(edges.weight[i]) * tukey * tukey;
    s0 += w;
    s1 += w * along;
    s2 += w * along * along;
    t0 += w * across;
    t1 += w * along * across;
    squares += w * w;
  }
  const double determinant = s0 * s2 - s1 * s1;
  if (s0 <= 0 || determinant <= 1e-9 * s0 * s0) return false;
  fit->offset = (s2 * t0 - s1 * t1) / determinant;
  fit->slope = (s0 * t1 - s1 * t0) / determinant;
  fit->inliers = s0 * s0 / squares;
  fit->offset_variance = s2 / determinant * s0 / fit->inliers;
  fit->slope_variance = s0 / determinant * s0 / fit->inliers;
  return true;
}

// Fits a straight line to the edge points, with Tukey weights, which push outliers out.
std::optional<LineFit> FitLine(const EdgePoints& edges) {
  LineFit fit = FirstGuess(edges);
  double limit = 1;
  for (int round = 0; round < 2; ++round) {
    for (int iteration = 0; iteration < 2; ++iteration) {
      if (!Reweighted(edges, limit, &fit)) return std::nullopt;
    }
    fit.scatter = Scatter(edges, fit);
    limit = std::max(4 * fit.scatter, 0.3);
  }
  return fit;
}

}  // namespace

double MeanNormalGradient(const GradientImage& gradient, const Segment2& segment) {
  constexpr int kMaxSamples = 32;
  const double length = segment.Length();
  if (!(length > 0)) return 0;
  const int samples = std::clamp(static_cast<int>(length / 2), 4, kMaxSamples);
  const Eigen::Vector2d step = (segment.end - segment.start) / samples;
  Eigen::Vector2d px = segment.start + 0.5 * step + Eigen::Vector2d(0.5, 0.5);
  int dx = 0;
  int dy = 0;
  for (int i = 0; i < samples; ++i, px += step) {
    if (!(px.x() >= 0 && px.y() >= 0 && px.x() < gradient.width() && px.y() < gradient.height())) {
      continue;
    }
    const int x = static_cast<int>(px.x());
    const int y = static_cast<int>(px.y());
    dx += gradient.dx.at(x, y);
    dy += gradient.dy.at(x, y);
  }
  return (step.x() * dy - step.y() * dx) / (length * kSobelGain);
}

std::optional<MeasuredSegment> RefineSegment(const GradientImage& gradient,
                                             const Segment2& segment,
                                             int range_px) {
  const double length = segment.Length();
  if (!(length >= 1) || !(length < 1e6) || range_px < 1 || range_px > 7) return std::nullopt;
  const Eigen::Vector2d direction = segment.Direction();
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  const Eigen::Vector2d middle = segment.Midpoint();
  const std::size_t samples =
      std::clamp(static_cast<std::size_t>(length / 2), kMinSamples, kMaxSamples);
  const double needed = kMinInliers * static_cast<double>(samples);
  const EdgePoints edges = EdgeFinder(gradient, segment, range_px).Find(length, samples);
  if (edges.size < kMinSamples || static_cast<double>(edges.size) < needed) return std::nullopt;
  const std::optional<LineFit> fit = FitLine(edges);
  if (!fit || fit->inliers < needed || fit->scatter > 1.5 || std::abs(fit->slope) > 0.3) {
    return std::nullopt;
  }
  const double half = 0.5 * length;
  MeasuredSegment result;
  result.segment.start = middle - half * direction + (fit->offset - half * fit->slope) * normal;
  result.segment.end = middle + half * direction + (fit->offset + half * fit->slope) * normal;
  result.sigma_px =
      fit->scatter * std::sqrt(fit->offset_variance + half * half * fit->slope_variance);
  return result;
}

namespace {

double Angle(const Segment2& segment) {
  const Eigen::Vector2d d = segment.end - segment.start;
  return math::Atan2(d.y(), d.x());
}

}  // namespace

CollinearIndex::CollinearIndex(const std::vector<LineFeature>& lines) {
  entries_.reserve(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    entries_.push_back({Angle(lines[i].segment), i, lines[i].segment.Midpoint()});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.line < b.line;
  });
}

std::vector<std::size_t> CollinearIndex::Near(const Segment2& segment,
                                              const LineMergeLimits& limits) const {
  std::vector<std::size_t> near;
  const double angle = Angle(segment);
  const double width = limits.angle_deg * kDegree;
  const Eigen::Vector3d line = LineThrough(segment);
  const auto collect = [&](double from, double to) {
    auto entry =
        std::lower_bound(entries_.begin(), entries_.end(), from, [](const Entry& e, double limit) {
          return e.angle < limit;
        });
    for (; entry != entries_.end() && entry->angle <= to; ++entry) {
      if (std::abs(LineDistance(line, entry->middle)) <= limits.offset_px) {
        near.push_back(entry->line);
      }
    }
  };
  collect(angle - width, angle + width);
  // Angles wrap around at pi.
  constexpr double kTurn = 2 * std::numbers::pi;
  if (angle + width > std::numbers::pi) collect(-std::numbers::pi, angle + width - kTurn);
  if (angle - width < -std::numbers::pi) collect(angle - width + kTurn, std::numbers::pi);
  std::sort(near.begin(), near.end());
  return near;
}

std::optional<Segment2> Join(const GradientImage& gradient,
                             const LineFeature& a,
                             const LineFeature& b,
                             const LineMergeLimits& limits) {
  const Eigen::Vector2d direction = a.segment.Direction();
  if (direction.dot(b.segment.Direction()) < math::Cos(limits.angle_deg * kDegree)) {
    return std::nullopt;
  }
  const Eigen::Vector3d line = LineThrough(a.segment);
  if (std::abs(LineDistance(line, b.segment.start)) > limits.offset_px ||
      std::abs(LineDistance(line, b.segment.end)) > limits.offset_px) {
    return std::nullopt;
  }
  const double a_length = a.segment.Length();
  const double b0 = direction.dot(b.segment.start - a.segment.start);
  const double b1 = direction.dot(b.segment.end - a.segment.start);
  const double gap = std::max(b0 - a_length, -b1);
  if (gap > limits.gap * std::min(a_length, b.segment.Length())) return std::nullopt;
  if (gap > 2) {  // the edge must be there in the gap, too
    const Segment2 between = b0 > a_length ? Segment2{a.segment.end, b.segment.start}
                                           : Segment2{b.segment.end, a.segment.start};
    if (-MeanNormalGradient(gradient, between) < 0.4 * std::min(a.response, b.response)) {
      return std::nullopt;
    }
  }
  return Segment2{b0 < 0 ? b.segment.start : a.segment.start,
                  b1 > a_length ? b.segment.end : a.segment.end};
}

}  // namespace plumbline
