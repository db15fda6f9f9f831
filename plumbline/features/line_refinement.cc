// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace plumbline {
namespace {

constexpr int kMaxSamples = 50;
constexpr int kMinSamples = 6;
constexpr double kMinInliers = 0.5;

struct EdgePoint {
  double along = 0;   // from the midpoint, px
  double across = 0;  // along the normal, px
  double weight = 0;
};

// Looks for the edge along rows or columns of pixels, whichever cross it more squarely: then the
// gradient is needed at whole pixels only.
class EdgeFinder {
 public:
  EdgeFinder(const GradientImage& gradient, const Segment2& segment, int range_px)
      : gradient_(gradient),
        middle_(segment.Midpoint()),
        direction_(segment.Direction()),
        normal_(-direction_.y(), direction_.x()),
        by_rows_(std::abs(normal_.x()) >= std::abs(normal_.y())),
        range_(std::min(kMaxReach, static_cast<int>(range_px * std::numbers::sqrt2 + 0.5))) {}

  // Places of the edge on about `samples` rows (columns) of the segment of this length.
  std::vector<EdgePoint> Find(double length, int samples) const {
    std::vector<EdgePoint> edges;
    edges.reserve(static_cast<std::size_t>(samples));
    const double major = by_rows_ ? direction_.y() : direction_.x();
    for (int i = 0; i < samples; ++i) {
      const double wanted = ((i + 0.5) / samples - 0.5) * length;
      const Eigen::Vector2d near = middle_ + wanted * direction_;
      const double grid = std::round(by_rows_ ? near.y() : near.x());
      const double along = (grid - (by_rows_ ? middle_.y() : middle_.x())) / major;
      if (const std::optional<EdgePoint> edge = FindOn(static_cast<int>(grid), along)) {
        edges.push_back(*edge);
      }
    }
    return edges;
  }

 private:
  static constexpr int kMaxReach = 10;

  // On one row (column) of pixels that the segment's line crosses at `along`.
  std::optional<EdgePoint> FindOn(int grid, double along) const {
    const Eigen::Vector2d crossing = middle_ + along * direction_;
    const double place = by_rows_ ? crossing.x() : crossing.y();
    const int center = static_cast<int>(std::lround(place));
    const int first = center - range_;
    const int limit = by_rows_ ? gradient_.width() : gradient_.height();
    const int other_limit = by_rows_ ? gradient_.height() : gradient_.width();
    if (first < 0 || center + range_ >= limit || grid < 0 || grid >= other_limit) {
      return std::nullopt;
    }
    const int count = 2 * range_ + 1;
    std::array<float, static_cast<std::size_t>(2 * kMaxReach + 1)> slope{};
    std::size_t best = 0;
    const auto nx = static_cast<float>(normal_.x() / kSobelGain);
    const auto ny = static_cast<float>(normal_.y() / kSobelGain);
    for (int k = 0; k < count; ++k) {
      const int x = by_rows_ ? first + k : grid;
      const int y = by_rows_ ? grid : first + k;
      const auto i = static_cast<std::size_t>(k);
      slope[i] = -nx * static_cast<float>(gradient_.dx.at(x, y)) -
                 ny * static_cast<float>(gradient_.dy.at(x, y));
      if (slope[i] > slope[best]) best = i;
    }
    if (best == 0 || static_cast<int>(best) == count - 1 || slope[best] < 1) return std::nullopt;
    const float curvature = slope[best - 1] - 2 * slope[best] + slope[best + 1];
    if (curvature >= 0) return std::nullopt;
    const float peak = 0.5F * (slope[best - 1] - slope[best + 1]) / curvature;
    const double offset = first + static_cast<int>(best) + static_cast<double>(peak) - place;
    // A step along the row (column) goes partly across and partly along the segment.
    return EdgePoint{along + offset * (by_rows_ ? direction_.x() : direction_.y()),
                     offset * (by_rows_ ? normal_.x() : normal_.y()),
                     static_cast<double>(slope[best])};
  }

  const GradientImage& gradient_;
  Eigen::Vector2d middle_;
  Eigen::Vector2d direction_;
  Eigen::Vector2d normal_;
  bool by_rows_;
  int range_;
};

struct LineFit {
  double offset = 0;  // across at the middle
  double slope = 0;
  double scatter = 0;  // robust deviation of the edge points from the line, px
  double inliers = 0;
  double offset_variance = 0;
  double slope_variance = 0;
};

// The line through two of the edge points, one near each end, that has most of the others close by.
LineFit FirstGuess(const std::vector<EdgePoint>& edges) {
  constexpr std::size_t kTries = 5;     // at each end
  constexpr double kClose = 0.5 * 0.5;  // square pixels
  const std::size_t third = edges.size() / 3;
  LineFit best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kTries; ++i) {
    for (std::size_t j = 0; j < kTries; ++j) {
      const EdgePoint& a = edges[i * third / kTries];
      const EdgePoint& b = edges[edges.size() - 1 - j * third / kTries];
      if (std::abs(b.along - a.along) < 1) continue;
      LineFit guess;
      guess.slope = (b.across - a.across) / (b.along - a.along);
      guess.offset = a.across - guess.slope * a.along;
      double cost = 0;
      for (const EdgePoint& e : edges) {
        const double r = e.across - guess.offset - guess.slope * e.along;
        cost += e.weight * std::min(r * r, kClose);
      }
      if (cost >= best_cost) continue;
      best_cost = cost;
      best = guess;
    }
  }
  return best;
}

// Weighted straight line through the edge points, outliers pushed out by Tukey weights.
std::optional<LineFit> FitLine(const std::vector<EdgePoint>& edges) {
  LineFit fit = FirstGuess(edges);
  double limit = 1;
  std::vector<double> residuals(edges.size());
  for (int iteration = 0; iteration < 4; ++iteration) {
    double s0 = 0;
    double s1 = 0;
    double s2 = 0;
    double t0 = 0;
    double t1 = 0;
    double squares = 0;
    for (const EdgePoint& e : edges) {
      const double r = e.across - fit.offset - fit.slope * e.along;
      const double u = r / limit;
      if (std::abs(u) >= 1) continue;
      const double w = e.weight * (1 - u * u) * (1 - u * u);
      s0 += w;
      s1 += w * e.along;
      s2 += w * e.along * e.along;
      t0 += w * e.across;
      t1 += w * e.along * e.across;
      squares += w * w;
    }
    const double determinant = s0 * s2 - s1 * s1;
    if (s0 <= 0 || determinant <= 1e-9 * s0 * s0) return std::nullopt;
    fit.offset = (s2 * t0 - s1 * t1) / determinant;
    fit.slope = (s0 * t1 - s1 * t0) / determinant;
    const double effective = s0 * s0 / squares;
    fit.inliers = effective;
    fit.offset_variance = s2 / determinant * s0 / effective;
    fit.slope_variance = s0 / determinant * s0 / effective;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      residuals[i] = std::abs(edges[i].across - fit.offset - fit.slope * edges[i].along);
    }
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    fit.scatter = 1.4826 * *middle;
    limit = std::max(4 * fit.scatter, 0.3);
  }
  return fit;
}

}  // namespace

std::optional<RefinedSegment> RefineSegment(const GradientImage& gradient,
                                            const Segment2& segment,
                                            int range_px) {
  const double length = segment.Length();
  if (length < 1 || range_px < 1 || range_px > 7) return std::nullopt;
  const Eigen::Vector2d direction = segment.Direction();
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  const Eigen::Vector2d middle = segment.Midpoint();
  const int samples = std::clamp(static_cast<int>(length / 2), kMinSamples, kMaxSamples);
  const std::vector<EdgePoint> edges =
      EdgeFinder(gradient, segment, range_px).Find(length, samples);
  if (static_cast<double>(edges.size()) < std::max<double>(kMinSamples, kMinInliers * samples)) {
    return std::nullopt;
  }
  const std::optional<LineFit> fit = FitLine(edges);
  if (!fit || fit->inliers < kMinInliers * samples || fit->scatter > 1.5 ||
      std::abs(fit->slope) > 0.3) {
    return std::nullopt;
  }
  const double half = 0.5 * length;
  RefinedSegment result;
  result.segment.start = middle - half * direction + (fit->offset - half * fit->slope) * normal;
  result.segment.end = middle + half * direction + (fit->offset + half * fit->slope) * normal;
  result.sigma_px =
      fit->scatter * std::sqrt(fit->offset_variance + half * half * fit->slope_variance);
  return result;
}

}  // namespace plumbline
