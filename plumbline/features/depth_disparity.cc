// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/depth_disparity.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

// Spread of the depths around a pixel, relative to depth, from which on there is an edge.
constexpr double kEdgeSpread = 0.05;

class DepthModel {
 public:
  DepthModel(const RectifiedCamera& camera, const DepthDisparityOptions& options)
      : camera_(camera), options_(options) {}

  bool InRange(double z) const { return z >= options_.min_depth_m && z <= options_.max_depth_m; }

  double DisparitySigma(double z) const {
    // Depth noise of structured light as Nguyen, Izadi and Lovell measured it [m], [1/m].
    constexpr double kConstant = 0.0012, kQuadratic = 0.0019;
    const double sigma_z = kConstant + kQuadratic * (z - 0.4) * (z - 0.4);
    return camera_.fx * camera_.baseline / (z * z) * sigma_z;
  }

 private:
  const RectifiedCamera& camera_;
  const DepthDisparityOptions& options_;
};

struct DepthSample {
  double z = 0;
  double spread = 0;  // largest minus smallest valid depth of the neighbourhood
};

// Returns the depth of the nearest pixel, with the spread over its 3x3 neighbourhood; nullopt if
// the pixel or more than half of its neighbours have no depth.
std::optional<DepthSample> SampleDepth(const DepthImage& depth, const Eigen::Vector2d& px) {
  if (!(px.x() >= 0 && px.y() >= 0 && px.x() <= depth.width() - 1 &&
        px.y() <= depth.height() - 1)) {
    return std::nullopt;
  }
  const int x = static_cast<int>(std::lround(px.x()));
  const int y = static_cast<int>(std::lround(px.y()));
  std::array<float, 9> values{};
  int count = 0;
  int looked = 0;
  for (int v = std::max(0, y - 1); v <= std::min(depth.height() - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(depth.width() - 1, x + 1); ++u) {
      const float z = depth.at(u, v);
      ++looked;
      if (z > 0) values[static_cast<std::size_t>(count++)] = z;
    }
  }
  if (2 * count <= looked) return std::nullopt;
  const auto end = values.begin() + count;
  const auto [low, high] = std::minmax_element(values.begin(), end);
  const float spread = *high - *low;
  std::nth_element(values.begin(), values.begin() + count / 2, end);
  const float own = depth.at(x, y);
  const float z = own > 0 ? own : values[static_cast<std::size_t>(count / 2)];
  return DepthSample{static_cast<double>(z), static_cast<double>(spread)};
}

// Samples along a line with their disparities, each kind of number in a vector of its own.
struct LinePoints {
  std::vector<double> t;  // 0 at the start, 1 at the end of the line
  std::vector<double> disparity;
  std::vector<double> sigma;
  std::vector<double> gate;  // largest distance from a fit

  explicit LinePoints(int most) {
    for (std::vector<double>* row : {&t, &disparity, &sigma, &gate}) {
      row->reserve(static_cast<std::size_t>(most));
    }
  }
  void Add(double place, double disparity_px, double sigma_px) {
    constexpr double kGate = 3;
    t.push_back(place);
    disparity.push_back(disparity_px);
    sigma.push_back(sigma_px);
    gate.push_back(kGate * sigma_px);
  }
  std::size_t size() const { return t.size(); }
};

struct DisparityFit {
  double start = 0;
  double end = 0;
  double sigma = 0;  // deviation of either end
  int inliers = 0;

  double At(double t) const { return (1 - t) * start + t * end; }
};

struct CountInliers {
  [[gnu::always_inline]] static inline int Run(const LinePoints& points, double start, double end) {
    const double* t = points.t.data();
    const double* disparity = points.disparity.data();
    const double* gate = points.gate.data();
    const std::size_t count = points.size();
    int inliers = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double at = (1 - t[i]) * start + t[i] * end;
      inliers += std::abs(disparity[i] - at) <= gate[i] ? 1 : 0;
    }
    return inliers;
  }
};

// Fits a straight course by least squares to the points that agree with `guess`.
std::optional<DisparityFit> Polish(const LinePoints& points, const DisparityFit& guess) {
  double s0 = 0;
  double s1 = 0;
  double s2 = 0;
  double d0 = 0;
  double d1 = 0;
  double sigma = 0;
  DisparityFit fit;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = points.t[i];
    const double disparity = points.disparity[i];
    if (!(std::abs(disparity - guess.At(t)) <= points.gate[i])) continue;
    const double w = 1 / (points.sigma[i] * points.sigma[i]);
    s0 += w;
    s1 += w * t;
    s2 += w * t * t;
    d0 += w * disparity;
    d1 += w * t * disparity;
    sigma += points.sigma[i];
    ++fit.inliers;
  }
  const double determinant = s0 * s2 - s1 * s1;
  if (fit.inliers < 3 || determinant <= 1e-9 * s0 * s0) return std::nullopt;
  fit.start = (s2 * d0 - s1 * d1) / determinant;
  fit.end = fit.start + (s0 * d1 - s1 * d0) / determinant;
  // Depth errors of neighbouring pixels are alike, so that averaging removes at most half of them.
  fit.sigma =
      std::max(0.5 * sigma / fit.inliers, std::sqrt(std::max(s2, s0 - 2 * s1 + s2) / determinant));
  return fit;
}

// Returns the straight course of disparity that most points share. Every pair of points that is far
// enough apart is tried.
std::optional<DisparityFit> FitDisparity(const LinePoints& points, int min_inliers) {
  constexpr double kMinSpan = 0.4;
  constexpr std::size_t kMaxTried = 12;
  DisparityFit best;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kMaxTried);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    for (std::size_t j = i + 1; j < points.size(); j += stride) {
      const double span = points.t[j] - points.t[i];
      if (span < kMinSpan) continue;
      const double slope = (points.disparity[j] - points.disparity[i]) / span;
      DisparityFit fit{points.disparity[i] - slope * points.t[i],
                       points.disparity[i] + slope * (1 - points.t[i]),
                       0,
                       0};
      fit.inliers = RunBest<CountInliers>(points, fit.start, fit.end);
      if (fit.inliers > best.inliers) best = fit;
    }
  }
  if (best.inliers < min_inliers) return std::nullopt;
  const std::optional<DisparityFit> fit = Polish(points, best);
  if (!fit || fit->inliers < min_inliers || fit->start <= 0 || fit->end <= 0) return std::nullopt;
  return fit;
}

// Fits a straight course to the depths along a copy of the segment that is moved sideways.
std::optional<DisparityFit> FitTrack(const RectifiedCamera& camera,
                                     const DepthImage& depth,
                                     const Segment2& segment,
                                     double side,
                                     const DepthDisparityOptions& options) {
  constexpr int kSamples = 32;  // number of samples along a line
  // Least share of the samples that lie on one straight line in space.
  constexpr double kMinInliers = 0.6;
  const DepthModel model(camera, options);
  const Eigen::Vector2d direction = segment.Direction();
  const Eigen::Vector2d offset = side * Eigen::Vector2d(-direction.y(), direction.x());
  LinePoints points(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    const double t = (i + 0.5) / kSamples;
    const Eigen::Vector2d px = segment.start + t * (segment.end - segment.start) + offset;
    const std::optional<DepthSample> sample = SampleDepth(depth, px);
    if (!sample || !model.InRange(sample->z)) continue;
    if (sample->spread > kEdgeSpread * sample->z) continue;
    points.Add(t, camera.DisparityFromDepth(sample->z), model.DisparitySigma(sample->z));
  }
  const int needed = static_cast<int>(std::ceil(kMinInliers * kSamples));
  if (static_cast<int>(points.size()) < needed) return std::nullopt;
  return FitDisparity(points, needed);
}

// Returns the course on the nearest surface, among those on the line and beside it.
std::optional<DisparityFit> NearestTrack(const RectifiedCamera& camera,
                                         const DepthImage& depth,
                                         const Segment2& segment,
                                         const DepthDisparityOptions& options) {
  constexpr double kSidePx = 2;
  std::optional<DisparityFit> best;
  for (const double side : {0.0, kSidePx, -kSidePx}) {
    const std::optional<DisparityFit> fit = FitTrack(camera, depth, segment, side, options);
    if (!fit) continue;
    // The line itself is preferred, unless one side is certainly nearer.
    constexpr double kCertain = 4;
    if (!best || fit->At(0.5) > best->At(0.5) + kCertain * std::max(best->sigma, fit->sigma)) {
      best = fit;
    }
  }
  return best;
}

}  // namespace

std::vector<std::optional<Disparity>> PointDisparities(const RectifiedCamera& camera,
                                                       const DepthImage& depth,
                                                       const std::vector<PointFeature>& points,
                                                       const DepthDisparityOptions& options) {
  PLUMBLINE_CHECK(camera.baseline > 0, "depth needs a virtual baseline");
  constexpr double kRegistrationSigmaPx = 0.5;  // deviation of the registration of depth to colour
  const DepthModel model(camera, options);
  std::vector<std::optional<Disparity>> result;
  result.reserve(points.size());
  for (const PointFeature& point : points) {
    result.emplace_back();
    const std::optional<DepthSample> sample = SampleDepth(depth, point.px);
    if (!sample || !model.InRange(sample->z)) continue;
    if (sample->spread > kEdgeSpread * sample->z) continue;
    const double disparity = camera.DisparityFromDepth(sample->z);
    // The spread covers two pixels: half of it is the slope of the depth, which a misregistration
    // turns into an error.
    const double slope = disparity * 0.5 * sample->spread / sample->z * kRegistrationSigmaPx;
    result.back() = Disparity{disparity, math::Hypot(model.DisparitySigma(sample->z), slope)};
  }
  return result;
}

std::vector<std::optional<MeasuredSegment>> VirtualRightLines(
    const RectifiedCamera& camera,
    const DepthImage& depth,
    const std::vector<LineFeature>& lines,
    const DepthDisparityOptions& options) {
  PLUMBLINE_CHECK(camera.baseline > 0, "depth needs a virtual baseline");
  std::vector<std::optional<MeasuredSegment>> result;
  result.reserve(lines.size());
  for (const LineFeature& line : lines) {
    result.emplace_back();
    if (!(line.segment.Length() > 0)) continue;
    const std::optional<DisparityFit> fit = NearestTrack(camera, depth, line.segment, options);
    if (!fit) continue;
    MeasuredSegment right;
    right.segment.start = line.segment.start - Eigen::Vector2d(fit->start, 0);
    right.segment.end = line.segment.end - Eigen::Vector2d(fit->end, 0);
    // Only the component of the disparity noise across the line counts.
    const double across = std::abs(line.segment.Direction().y()) * fit->sigma;
    right.sigma_px = math::Hypot(line.sigma_px, across);
    result.back() = right;
  }
  return result;
}

}  // namespace plumbline
