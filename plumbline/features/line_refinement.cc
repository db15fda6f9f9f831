// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_refinement.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumbline {
namespace {

constexpr int kMaxSamples = 60;
constexpr int kMinSamples = 6;
constexpr double kMinInliers = 0.5;

struct EdgePoint {
  double along = 0;   // from the midpoint, px
  double across = 0;  // along the normal, px
  double weight = 0;
};

// Sub-pixel place of the steepest descent along `normal` within +-range of `px`, if there is one.
bool FindEdge(const GradientImage& gradient,
              const Eigen::Vector2d& px,
              const Eigen::Vector2d& normal,
              int range,
              EdgePoint* edge) {
  constexpr int kMaxProfile = 16;
  const int count = 2 * range + 1;
  double slope[kMaxProfile];
  int best = -1;
  for (int k = 0; k < count; ++k) {
    slope[k] = -normal.dot(GradientAt(gradient, px + (k - range) * normal));
    if (best < 0 || slope[k] > slope[best]) best = k;
  }
  if (best == 0 || best == count - 1 || slope[best] < 1) return false;
  const double curvature = slope[best - 1] - 2 * slope[best] + slope[best + 1];
  if (curvature >= 0) return false;
  edge->across = best - range + 0.5 * (slope[best - 1] - slope[best + 1]) / curvature;
  edge->weight = slope[best];
  return true;
}

struct LineFit {
  double offset = 0;  // across at the middle
  double slope = 0;
  double scatter = 0;  // robust deviation of the edge points from the line, px
  double inliers = 0;
  double offset_variance = 0;
  double slope_variance = 0;
};

// Weighted straight line through the edge points, outliers pushed out by Tukey weights.
std::optional<LineFit> FitLine(const std::vector<EdgePoint>& edges) {
  LineFit fit;
  double limit = 1e9;
  std::vector<double> residuals;
  for (int iteration = 0; iteration < 5; ++iteration) {
    double s0 = 0;
    double s1 = 0;
    double s2 = 0;
    double t0 = 0;
    double t1 = 0;
    double squares = 0;
    residuals.clear();
    for (const EdgePoint& e : edges) {
      const double r = e.across - fit.offset - fit.slope * e.along;
      residuals.push_back(iteration == 0 ? 0 : std::abs(r));
      const double u = iteration == 0 ? 0 : r / limit;
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
  const int samples = std::clamp(static_cast<int>(length), kMinSamples, kMaxSamples);
  std::vector<EdgePoint> edges;
  edges.reserve(static_cast<std::size_t>(samples));
  for (int i = 0; i < samples; ++i) {
    EdgePoint edge;
    edge.along = ((i + 0.5) / samples - 0.5) * length;
    if (FindEdge(gradient, middle + edge.along * direction, normal, range_px, &edge)) {
      edges.push_back(edge);
    }
  }
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
