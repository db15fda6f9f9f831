// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/orb.h"

#include "plumbline/base/error.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <tuple>

#include <opencv2/features2d.hpp>

namespace plumbline {
namespace {

constexpr int kCentroidRadius = 15;
constexpr int kPatchRadius = 19;  // the turned sampling pattern stays inside

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
  return std::atan2(static_cast<double>(moment_y), static_cast<double>(moment_x));
}

// Place of the extreme of a parabola through three values at -1, 0, 1; 0 when it is not between.
double ParabolaPeak(double before, double at, double after) {
  const double curvature = before - 2 * at + after;
  if (curvature >= 0) return 0;
  return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

// Sub-pixel peak of the Harris response around a corner, offset from the pixel centre.
Eigen::Vector2d CornerOffset(const GrayImage& image, int x, int y) {
  constexpr int kWindow = 2;
  constexpr int kReach = kWindow + 1;
  constexpr int kSide = 2 * kReach + 1;
  std::array<std::array<float, 3>, static_cast<std::size_t>(kSide * kSide)> products;
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
      products[k] = {gx * gx, gx * gy, gy * gy};
    }
  }
  const auto response = [&](int sx, int sy) {
    float xx = 0;
    float xy = 0;
    float yy = 0;
    for (int v = -kWindow; v <= kWindow; ++v) {
      for (int u = -kWindow; u <= kWindow; ++u) {
        const auto& p =
            products[static_cast<std::size_t>((sy + v + kReach) * kSide + sx + u + kReach)];
        xx += p[0];
        xy += p[1];
        yy += p[2];
      }
    }
    return static_cast<double>(xx * yy - xy * xy - 0.04F * (xx + yy) * (xx + yy));
  };
  const double center = response(0, 0);
  return {ParabolaPeak(response(-1, 0), center, response(1, 0)),
          ParabolaPeak(response(0, -1), center, response(0, 1))};
}

std::vector<Descriptor> Describe(const GrayImage& image,
                                 const std::vector<PointFeature>& points,
                                 const std::vector<Corner>& corners) {
  std::vector<Descriptor> descriptors(points.size());
  if (points.empty()) return descriptors;
  std::vector<cv::KeyPoint> keypoints;
  keypoints.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double degrees = points[i].angle * 180 / std::numbers::pi;
    keypoints.emplace_back(static_cast<float>(corners[i].x),
                           static_cast<float>(corners[i].y),
                           31.F,
                           static_cast<float>(degrees < 0 ? degrees + 360 : degrees),
                           0.F,
                           0,
                           static_cast<int>(i));
  }
  // One level, no border: OpenCV only blurs and samples its pattern; the class id carries our
  // index.
  const auto orb = cv::ORB::create(static_cast<int>(points.size()), 1.2F, 1, 0);
  cv::Mat rows;
  orb->compute(AsMat(image), keypoints, rows);
  PLUMBLINE_CHECK(rows.rows == static_cast<int>(keypoints.size()), "a descriptor for each point");
  for (int i = 0; i < rows.rows; ++i) {
    const auto index = static_cast<std::size_t>(keypoints[static_cast<std::size_t>(i)].class_id);
    std::memcpy(descriptors[index].data(), rows.ptr(i), sizeof(Descriptor));
  }
  return descriptors;
}

void ExtractLevel(const PyramidLevel& level,
                  int octave,
                  const ValidRegion& valid,
                  std::size_t count,
                  const OrbOptions& options,
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
  points.reserve(corners.size());
  for (const Corner& c : corners) {
    Eigen::Vector2d px(c.x, c.y);
    if (options.subpixel) px += CornerOffset(level.image, c.x, c.y);
    PointFeature point;
    point.px = level.ToFull(px);
    point.sigma_px = options.sigma_px * scale;
    point.angle = CentroidAngle(level.image, c.x, c.y);
    point.response = static_cast<double>(c.response);
    point.octave = octave;
    points.push_back(point);
  }
  const std::vector<Descriptor> descriptors = Describe(level.image, points, corners);
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
  double total = 0;
  for (const PyramidLevel& level : pyramid) total += 1 / level.scale.maxCoeff();
  // What a level cannot fill is left to the ones above it.
  std::size_t wanted = 0;
  double share = 0;
  for (std::size_t octave = 0; octave < pyramid.size(); ++octave) {
    share += count / pyramid[octave].scale.maxCoeff() / total;
    wanted = static_cast<std::size_t>(std::lround(share));
    if (wanted <= result.size()) continue;
    ExtractLevel(
        pyramid[octave], static_cast<int>(octave), valid, wanted - result.size(), options, &result);
  }
  return result;
}

}  // namespace plumbline
