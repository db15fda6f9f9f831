// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/orb.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/features/orb_descriptor.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include <opencv2/features2d.hpp>

namespace plumbline {
namespace {

constexpr int kCentroidRadius = 15;
constexpr int kPatchRadius = 20;  // the turned sampling pattern (18.4) and a shift stay inside

struct Corner {
  int x = 0;
  int y = 0;
  float response = 0;
};

// FAST needs 3 pixels around a corner: the window for corners in `area` is larger by that.
void FastIn(const cv::Mat& image,
            const cv::Rect& area,
            int threshold,
            std::vector<Corner>* corners) {
  std::vector<cv::KeyPoint> found;
  const cv::Rect window(area.x - 3, area.y - 3, area.width + 6, area.height + 6);
  cv::FAST(image(window), found, threshold, true);
  for (const cv::KeyPoint& k : found) {
    corners->push_back(
        {static_cast<int>(k.pt.x) + window.x, static_cast<int>(k.pt.y) + window.y, k.response});
  }
}

// Corners of one level, at least kPatchRadius from its border.
std::vector<Corner> DetectCorners(const GrayImage& image, const OrbOptions& options) {
  const cv::Rect area(kPatchRadius,
                      kPatchRadius,
                      image.width() - 2 * kPatchRadius,
                      image.height() - 2 * kPatchRadius);
  std::vector<Corner> corners;
  if (area.width <= 0 || area.height <= 0) return corners;
  const cv::Mat mat = AsMat(image);
  FastIn(mat, area, options.fast_threshold, &corners);
  const int columns = (area.width + options.cell_px - 1) / options.cell_px;
  const int rows = (area.height + options.cell_px - 1) / options.cell_px;
  std::vector<bool> occupied(static_cast<std::size_t>(columns * rows), false);
  for (const Corner& c : corners) {
    const int cell = (c.y - area.y) / options.cell_px * columns + (c.x - area.x) / options.cell_px;
    occupied[static_cast<std::size_t>(cell)] = true;
  }
  if (options.fast_min_threshold >= options.fast_threshold) return corners;
  for (int cell = 0; cell < columns * rows; ++cell) {
    if (occupied[static_cast<std::size_t>(cell)]) continue;
    const cv::Rect box(area.x + cell % columns * options.cell_px,
                       area.y + cell / columns * options.cell_px,
                       options.cell_px,
                       options.cell_px);
    FastIn(mat, box & area, options.fast_min_threshold, &corners);
  }
  return corners;
}

// Takes the strongest of each cell of a grid, then the second of each, and so on.
std::vector<Corner> SpreadSelect(std::vector<Corner> corners,
                                 int width,
                                 int height,
                                 std::size_t count) {
  if (corners.size() <= count || count == 0) {
    if (count == 0) corners.clear();
    return corners;
  }
  const double side = std::sqrt(static_cast<double>(width) * height / static_cast<double>(count));
  const int columns = static_cast<int>(std::ceil(width / side));
  struct Ranked {
    int rank;
    int cell;
    Corner corner;
  };
  std::vector<Ranked> ranked;
  ranked.reserve(corners.size());
  for (const Corner& c : corners) {
    ranked.push_back({0, static_cast<int>(c.y / side) * columns + static_cast<int>(c.x / side), c});
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return std::tuple(a.cell, -a.corner.response, a.corner.y, a.corner.x) <
           std::tuple(b.cell, -b.corner.response, b.corner.y, b.corner.x);
  });
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    if (ranked[i].cell == ranked[i - 1].cell) ranked[i].rank = ranked[i - 1].rank + 1;
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return std::tuple(a.rank, -a.corner.response, a.corner.y, a.corner.x) <
           std::tuple(b.rank, -b.corner.response, b.corner.y, b.corner.x);
  });
  corners.clear();
  for (std::size_t i = 0; i < count; ++i) corners.push_back(ranked[i].corner);
  return corners;
}

// Half-width of the disc of kCentroidRadius at each row.
std::array<int, kCentroidRadius + 1> DiscRows() {
  std::array<int, kCentroidRadius + 1> half{};
  for (int y = 0; y <= kCentroidRadius; ++y) {
    half[static_cast<std::size_t>(y)] =
        static_cast<int>(std::sqrt(static_cast<double>(kCentroidRadius * kCentroidRadius - y * y)));
  }
  return half;
}

// Direction from the corner to the centroid of the grey levels around it (Rosin 1999), radians.
double CentroidAngle(const GrayImage& image, int x, int y) {
  static const std::array<int, kCentroidRadius + 1> kHalf = DiscRows();
  int moment_x = 0;
  int moment_y = 0;
  for (int dy = -kCentroidRadius; dy <= kCentroidRadius; ++dy) {
    const std::uint8_t* row = image.row(y + dy) + x;
    const int half = kHalf[static_cast<std::size_t>(std::abs(dy))];
    int sum = 0;
    for (int dx = -half; dx <= half; ++dx) {
      sum += row[dx];
      moment_x += dx * row[dx];
    }
    moment_y += dy * sum;
  }
  return math::Atan2(static_cast<double>(moment_y), static_cast<double>(moment_x));
}

// Place of the extreme of a parabola through three values at -1, 0, 1; 0 when it is not between.
double ParabolaPeak(double before, double at, double after) {
  const double curvature = before - 2 * at + after;
  if (curvature >= 0) return 0;
  return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

// Harris response at whole-pixel offsets, up to 2, from a corner; windows of 5x5 pixels, weighted
// by a Gaussian: with a box, pixels that enter and leave at its border move the peak.
class HarrisAround {
 public:
  HarrisAround(const GrayImage& image, int x, int y) {
    std::size_t k = 0;
    for (int dy = -kReach; dy <= kReach; ++dy) {
      const std::uint8_t* above = image.row(y + dy - 1) + x;
      const std::uint8_t* row = image.row(y + dy) + x;
      const std::uint8_t* below = image.row(y + dy + 1) + x;
      for (int dx = -kReach; dx <= kReach; ++dx, ++k) {
        const auto gx = static_cast<float>(2 * (row[dx + 1] - row[dx - 1]) + above[dx + 1] -
                                           above[dx - 1] + below[dx + 1] - below[dx - 1]);
        const auto gy = static_cast<float>(2 * (below[dx] - above[dx]) + below[dx + 1] -
                                           above[dx + 1] + below[dx - 1] - above[dx - 1]);
        products_[k] = {gx * gx, gx * gy, gy * gy};
      }
    }
  }

  double At(int dx, int dy) const {
    float xx = 0;
    float xy = 0;
    float yy = 0;
    static const Weights kWeights = MakeWeights();
    auto weight = kWeights.begin();
    for (int v = dy - kWindow; v <= dy + kWindow; ++v) {
      for (int u = dx - kWindow; u <= dx + kWindow; ++u, ++weight) {
        const auto& p = products_[static_cast<std::size_t>((v + kReach) * kSide + u + kReach)];
        xx += *weight * p[0];
        xy += *weight * p[1];
        yy += *weight * p[2];
      }
    }
    constexpr float kTrace = 0.04F;
    return static_cast<double>(xx * yy - xy * xy - kTrace * (xx + yy) * (xx + yy));
  }

 private:
  static constexpr int kWindow = 2;
  static constexpr int kReach = kWindow + 2;
  static constexpr int kSide = 2 * kReach + 1;
  using Weights =
      std::array<float, static_cast<std::size_t>((2 * kWindow + 1) * (2 * kWindow + 1))>;

  static Weights MakeWeights() {
    constexpr double kSigma = 1.2;
    Weights weights{};
    std::size_t k = 0;
    for (int v = -kWindow; v <= kWindow; ++v) {
      for (int u = -kWindow; u <= kWindow; ++u) {
        weights[k++] = static_cast<float>(math::Exp(-0.5 * (u * u + v * v) / (kSigma * kSigma)));
      }
    }
    return weights;
  }

  std::array<std::array<float, 3>, static_cast<std::size_t>(kSide* kSide)> products_;
};

// Sub-pixel peak of the Harris response near a FAST corner, offset from the pixel centre. The peak
// may lie on a neighbouring pixel.
Eigen::Vector2d CornerOffset(const GrayImage& image, int x, int y) {
  const HarrisAround harris(image, x, y);
  Eigen::Vector2i best(0, 0);
  double peak = harris.At(0, 0);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const double response = harris.At(dx, dy);
      if (response <= peak) continue;
      peak = response;
      best = {dx, dy};
    }
  }
  const int u = best.x();
  const int v = best.y();
  return {u + ParabolaPeak(harris.At(u - 1, v), peak, harris.At(u + 1, v)),
          v + ParabolaPeak(harris.At(u, v - 1), peak, harris.At(u, v + 1))};
}

void ExtractLevel(const PyramidLevel& level,
                  int octave,
                  const ValidRegion& valid,
                  std::size_t count,
                  const OrbOptions& options,
                  double calibration_sigma_px,
                  std::vector<PointFeature>* result) {
  const double scale = level.scale.maxCoeff();
  std::vector<Corner> corners = DetectCorners(level.image, options);
  std::erase_if(corners, [&](const Corner& c) {
    // The border of the level was respected already; only invalid pixels are left to check.
    const Eigen::Vector2d full = level.ToFull(Eigen::Vector2d(c.x, c.y));
    return !valid.Contains(full, (kPatchRadius - 1) * scale);
  });
  corners = SpreadSelect(std::move(corners), level.image.width(), level.image.height(), count);
  std::vector<PointFeature> points;
  std::vector<Eigen::Vector2d> places;  // on the level
  std::vector<OrientedPixel> pixels;
  for (const Corner& c : corners) {
    Eigen::Vector2d px(c.x, c.y);
    if (options.subpixel) px += CornerOffset(level.image, c.x, c.y);
    // Two corners may have moved to one peak; the first one is the stronger.
    if (std::any_of(places.begin(), places.end(), [&](const Eigen::Vector2d& other) {
          return (other - px).squaredNorm() < 1;
        })) {
      continue;
    }
    places.push_back(px);
    PointFeature point;
    point.px = level.ToFull(px);
    const double noise_sigma = options.noise_sigma_px / static_cast<double>(c.response);
    point.sigma_px =
        math::Hypot(math::Hypot(options.sigma_px, noise_sigma) * scale, calibration_sigma_px);
    const int x = static_cast<int>(std::lround(px.x()));
    const int y = static_cast<int>(std::lround(px.y()));
    point.angle = CentroidAngle(level.image, x, y);
    pixels.push_back({x, y, point.angle});
    point.response = static_cast<double>(c.response);
    point.octave = octave;
    points.push_back(point);
  }
  const std::vector<Descriptor> descriptors = DescribeOrb(level.image, pixels);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].descriptor = descriptors[i];
  result->insert(result->end(), points.begin(), points.end());
}

}  // namespace

ImagePyramid BuildOrbPyramid(const GrayImage& image, const OrbOptions& options) {
  return BuildPyramid(image, options.levels, options.scale_factor);
}

std::vector<PointFeature> ExtractOrb(const ImagePyramid& pyramid,
                                     const ValidRegion& valid,
                                     int count,
                                     const OrbOptions& options) {
  std::vector<PointFeature> result;
  if (pyramid.empty() || count <= 0) return result;
  const double calibration_sigma_px = options.calibration_sigma * pyramid[0].image.width();
  double total = 0;
  for (const PyramidLevel& level : pyramid) total += 1 / level.scale.maxCoeff();
  // What a level cannot fill is left to the ones above it.
  std::size_t wanted = 0;
  double share = 0;
  for (std::size_t octave = 0; octave < pyramid.size(); ++octave) {
    share += count / pyramid[octave].scale.maxCoeff() / total;
    wanted = static_cast<std::size_t>(std::lround(share));
    if (wanted <= result.size()) continue;
    ExtractLevel(pyramid[octave],
                 static_cast<int>(octave),
                 valid,
                 wanted - result.size(),
                 options,
                 calibration_sigma_px,
                 &result);
  }
  return result;
}

}  // namespace plumbline
