// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/orb.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"
#include "plumbline/features/fast_corners.h"
#include "plumbline/features/orb_descriptor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace plumbline {
namespace {

// Levels of the pyramid; with a factor of 1.2 the coarsest is 3.6 times smaller.
constexpr int kLevels = 8;
// Side of the cells of a level, which each have a threshold.
constexpr int kCellPx = 35;
constexpr int kCentroidRadius = 15;
// The turned sampling pattern (18.4) and a shift stay inside this radius.
constexpr int kPatchRadius = 20;

// Returns the corners of one level that are at least kPatchRadius from its border.
std::vector<FastCorner> DetectCorners(const GrayImage& image, const OrbOptions& options) {
  const PixelBox area{
      kPatchRadius, kPatchRadius, image.width() - kPatchRadius, image.height() - kPatchRadius};
  std::vector<FastCorner> corners;
  if (area.empty()) return corners;
  const FastCorners fast(image, area);
  fast.Collect(area, kCornerContrast, &corners);
  const int columns = (area.x1 - area.x0 + kCellPx - 1) / kCellPx;
  const int rows = (area.y1 - area.y0 + kCellPx - 1) / kCellPx;
  std::vector<bool> occupied(static_cast<std::size_t>(columns * rows), false);
  for (const FastCorner& c : corners) {
    const int cell = (c.y - area.y0) / kCellPx * columns + (c.x - area.x0) / kCellPx;
    occupied[static_cast<std::size_t>(cell)] = true;
  }
  if (options.fast_min_threshold >= kCornerContrast) return corners;
  for (int cell = 0; cell < columns * rows; ++cell) {
    if (occupied[static_cast<std::size_t>(cell)]) continue;
    const int x = area.x0 + cell % columns * kCellPx;
    const int y = area.y0 + cell / columns * kCellPx;
    fast.Collect({x, y, x + kCellPx, y + kCellPx}, options.fast_min_threshold, &corners);
  }
  return corners;
}

// Returns the place of a corner in the order of selection as one number: ordered first by `first`,
// which is below 2^24, then by strength, the strongest first, then row by row. `width` is that of
// the image.
constexpr int kStrongest = 255;
std::uint64_t OrderOf(std::uint64_t first, const FastCorner& c, int width) {
  const auto weakness = static_cast<std::uint64_t>(kStrongest - static_cast<int>(c.response));
  const auto pixel = static_cast<std::uint64_t>(c.y) * static_cast<std::uint64_t>(width) +
                     static_cast<std::uint64_t>(c.x);
  return first << 40 | weakness << 32 | pixel;
}

FastCorner CornerOf(std::uint64_t order, int width) {
  const auto pixel = static_cast<std::uint32_t>(order);
  const auto row = pixel / static_cast<std::uint32_t>(width);
  const auto column = pixel % static_cast<std::uint32_t>(width);
  return {static_cast<int>(column),
          static_cast<int>(row),
          static_cast<float>(kStrongest - static_cast<int>(order >> 32 & 0xFFU))};
}

// Takes the strongest corner of each cell of a grid, then the second of each, and so on.
std::vector<FastCorner> SpreadSelect(std::vector<FastCorner> corners,
                                     int width,
                                     int height,
                                     std::size_t count) {
  if (corners.size() <= count || count == 0) {
    if (count == 0) corners.clear();
    return corners;
  }
  const double side = std::sqrt(static_cast<double>(width) * height / static_cast<double>(count));
  const int columns = static_cast<int>(std::ceil(width / side));
  std::vector<std::uint64_t> order;
  order.reserve(corners.size());
  for (const FastCorner& c : corners) {
    const int cell = static_cast<int>(c.y / side) * columns + static_cast<int>(c.x / side);
    order.push_back(OrderOf(static_cast<std::uint64_t>(cell), c, width));
  }
  std::sort(order.begin(), order.end());
  std::uint64_t cell = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t rank = 0;
  for (std::uint64_t& entry : order) {
    rank = entry >> 40 == cell ? rank + 1 : 0;
    cell = entry >> 40;
    entry = OrderOf(rank, CornerOf(entry, width), width);
  }
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
  corners.clear();
  for (std::size_t i = 0; i < count; ++i) corners.push_back(CornerOf(order[i], width));
  return corners;
}

// The disc of kCentroidRadius around a corner, row by row. Inside it each pixel has 1 and the
// distance along the row, outside it 0. Rows are two vectors long.
constexpr std::size_t kDiscRows = 2 * kCentroidRadius + 1;
constexpr std::size_t kDiscColumns = kDiscRows + 1;
struct Disc {
  std::array<std::array<std::int16_t, kDiscColumns>, kDiscRows> inside{};
  std::array<std::array<std::int16_t, kDiscColumns>, kDiscRows> dx{};
};

Disc MakeDisc() {
  Disc disc;
  for (int dy = -kCentroidRadius; dy <= kCentroidRadius; ++dy) {
    const auto half = static_cast<int>(
        std::sqrt(static_cast<double>(kCentroidRadius * kCentroidRadius - dy * dy)));
    for (int dx = -half; dx <= half; ++dx) {
      const auto row = static_cast<std::size_t>(dy + kCentroidRadius);
      const auto column = static_cast<std::size_t>(dx + kCentroidRadius);
      disc.inside[row][column] = 1;
      disc.dx[row][column] = static_cast<std::int16_t>(dx);
    }
  }
  return disc;
}

struct Moments {
  int x = 0;
  int y = 0;
};

struct DiscMoments {
  // `corner` is the first pixel of the disc's square in an image of this width.
  [[gnu::always_inline]] static inline Moments Run(const Disc& disc,
                                                   const std::uint8_t* corner,
                                                   std::ptrdiff_t width) {
    Moments moments;
    for (std::size_t row = 0; row < kDiscRows; ++row, corner += width) {
      std::array<std::int16_t, kDiscColumns> level;
      for (std::size_t i = 0; i < kDiscColumns; ++i) level[i] = corner[i];
      int sum = 0;
      for (std::size_t i = 0; i < kDiscColumns; ++i) sum += disc.inside[row][i] * level[i];
      int moment = 0;
      for (std::size_t i = 0; i < kDiscColumns; ++i) moment += disc.dx[row][i] * level[i];
      moments.x += moment;
      moments.y += (static_cast<int>(row) - kCentroidRadius) * sum;
    }
    return moments;
  }
};

// Returns the direction from the corner to the centroid of the grey levels around it (Rosin 1999),
// in radians.
double CentroidAngle(const GrayImage& image, int x, int y) {
  static const Disc kDisc = MakeDisc();
  const Moments moments = RunBest<DiscMoments>(
      kDisc, image.row(y - kCentroidRadius) + x - kCentroidRadius, image.width());
  return math::Atan2(static_cast<double>(moments.y), static_cast<double>(moments.x));
}

// Returns the place of the extreme of a parabola through three values at -1, 0, 1; 0 when it is not
// between them.
double ParabolaPeak(double before, double at, double after) {
  const double curvature = before - 2 * at + after;
  if (curvature >= 0) return 0;
  return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

// Computes the Harris response at whole-pixel offsets, up to 2, from a corner. Windows of 5x5
// pixels are weighted by a Gaussian: in a box, pixels that enter and leave at its border would move
// the peak.
class HarrisAround {
 public:
  static constexpr std::size_t kLanes = 4;
  using Responses = std::array<float, kLanes>;  // responses at -1, 0, 1, 2

  HarrisAround(const GrayImage& image, int x, int y) {
    for (int dy = -kReach; dy <= kReach; ++dy) {
      const std::uint8_t* above = image.row(y + dy - 1) + x - kReach;
      const std::uint8_t* row = image.row(y + dy) + x - kReach;
      const std::uint8_t* below = image.row(y + dy + 1) + x - kReach;
      float* products = products_.data() + static_cast<std::ptrdiff_t>((dy + kReach) * kStride);
      for (int k = 0; k < kStride; ++k) {
        const int left = above[k - 1] + 2 * row[k - 1] + below[k - 1];
        const int right = above[k + 1] + 2 * row[k + 1] + below[k + 1];
        const int top = above[k - 1] + 2 * above[k] + above[k + 1];
        const int bottom = below[k - 1] + 2 * below[k] + below[k + 1];
        const auto gx = static_cast<float>(right - left);
        const auto gy = static_cast<float>(bottom - top);
        products[k] = gx * gx;
        products[k + kPlane] = gx * gy;
        products[k + 2 * kPlane] = gy * gy;
      }
    }
  }

  // Returns the responses on row dy (at most 2 away), at kLanes places from -1 on.
  Responses OnRow(int dy) const {
    Sums xx{};
    Sums xy{};
    Sums yy{};
    auto weight = Gaussian().begin();
    for (int v = dy - kWindow; v <= dy + kWindow; ++v) {
      const float* products = products_.data() + (v + kReach) * kStride + kReach - kWindow - 1;
      for (int u = 0; u <= 2 * kWindow; ++u, ++weight, ++products) {
        AddWeighted(*weight, products, xx);
        AddWeighted(*weight, products + kPlane, xy);
        AddWeighted(*weight, products + 2 * kPlane, yy);
      }
    }
    Responses responses;
    for (std::size_t k = 0; k < kLanes; ++k) responses[k] = Response(xx[k], xy[k], yy[k]);
    return responses;
  }

  // Returns the response at a single place, at most 2 away.
  float At(int dx, int dy) const {
    float xx = 0;
    float xy = 0;
    float yy = 0;
    auto weight = Gaussian().begin();
    for (int v = dy - kWindow; v <= dy + kWindow; ++v) {
      const float* products = products_.data() + (v + kReach) * kStride + kReach + dx - kWindow;
      for (int u = 0; u <= 2 * kWindow; ++u, ++weight, ++products) {
        xx += *weight * products[0];
        xy += *weight * products[kPlane];
        yy += *weight * products[2 * kPlane];
      }
    }
    return Response(xx, xy, yy);
  }

 private:
  static constexpr int kWindow = 2;
  static constexpr int kReach = kWindow + 2;
  static constexpr int kSide = 2 * kReach + 1;
  static constexpr int kStride = 12;  // whole vectors; the last three columns are not used
  static constexpr int kPlane = kSide * kStride;
  using Sums = std::array<float, kLanes>;
  using Weights =
      std::array<float, static_cast<std::size_t>((2 * kWindow + 1) * (2 * kWindow + 1))>;

  static void AddWeighted(float weight, const float* products, Sums& sums) {
    for (std::size_t k = 0; k < kLanes; ++k) sums[k] += weight * products[k];
  }

  static float Response(float xx, float xy, float yy) {
    constexpr float kTrace = 0.04F;
    return xx * yy - xy * xy - kTrace * (xx + yy) * (xx + yy);
  }

  static const Weights& Gaussian() {
    static const Weights kWeights = MakeWeights();
    return kWeights;
  }

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

  // Products of the derivatives along x and y: xx, xy, yy, one plane after the other.
  std::array<float, static_cast<std::size_t>(3 * kPlane)> products_;
};

// Returns the sub-pixel peak of the Harris response near a FAST corner, as an offset from the pixel
// centre. The peak may lie on a neighbouring pixel.
Eigen::Vector2d CornerOffset(const GrayImage& image, int x, int y) {
  const HarrisAround harris(image, x, y);
  const std::array near{harris.OnRow(-1), harris.OnRow(0), harris.OnRow(1)};
  const auto at = [&](int dx, int dy) {
    const bool known = std::abs(dy) <= 1 && dx >= -1;
    return static_cast<double>(
        known ? near[static_cast<std::size_t>(dy + 1)][static_cast<std::size_t>(dx + 1)]
              : harris.At(dx, dy));
  };
  int u = 0;
  int v = 0;
  double peak = at(0, 0);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (at(dx, dy) <= peak) continue;
      peak = at(dx, dy);
      u = dx;
      v = dy;
    }
  }
  return {u + ParabolaPeak(at(u - 1, v), peak, at(u + 1, v)),
          v + ParabolaPeak(at(u, v - 1), peak, at(u, v + 1))};
}

void ExtractLevel(const PyramidLevel& level,
                  int octave,
                  const ValidRegion& valid,
                  std::size_t count,
                  const OrbOptions& options,
                  double calibration_sigma_px,
                  std::vector<PointFeature>* result) {
  const double scale = level.scale.maxCoeff();
  std::vector<FastCorner> corners = DetectCorners(level.image, options);
  std::erase_if(corners, [&](const FastCorner& c) {
    // Detection kept to the border of the level already; only invalid pixels are left to check.
    const Eigen::Vector2d full = level.ToFull(Eigen::Vector2d(c.x, c.y));
    return !valid.Contains(full, (kPatchRadius - 1) * scale);
  });
  corners = SpreadSelect(std::move(corners), level.image.width(), level.image.height(), count);
  std::vector<PointFeature> points;
  std::vector<Eigen::Vector2d> places;  // places on the level
  std::vector<OrientedPixel> pixels;
  for (const FastCorner& c : corners) {
    Eigen::Vector2d px(c.x, c.y);
    px += CornerOffset(level.image, c.x, c.y);
    // Two corners may have moved to one peak; the first one is the stronger and stays.
    if (std::any_of(places.begin(), places.end(), [&](const Eigen::Vector2d& other) {
          return (other - px).squaredNorm() < 1;
        })) {
      continue;
    }
    places.push_back(px);
    PointFeature point;
    point.px = level.ToFull(px);
    const double noise_sigma = kCornerNoiseSigmaPx / static_cast<double>(c.response);
    point.sigma_px =
        math::Hypot(math::Hypot(kCornerSigmaPx, noise_sigma) * scale, calibration_sigma_px);
    const int x = static_cast<int>(std::lround(px.x()));
    const int y = static_cast<int>(std::lround(px.y()));
    const double angle = CentroidAngle(level.image, x, y);
    pixels.push_back({x, y, angle});
    point.angle = static_cast<float>(angle);
    point.response = static_cast<std::uint16_t>(c.response);
    point.octave = static_cast<std::int16_t>(octave);
    points.push_back(point);
  }
  const std::vector<Descriptor> descriptors = DescribeOrb(level.image, pixels);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].descriptor = descriptors[i];
  result->insert(result->end(), points.begin(), points.end());
}

}  // namespace

std::vector<std::optional<Descriptor>> DescribeOrbAt(const ImagePyramid& pyramid,
                                                     const std::vector<PointFeature>& corners) {
  std::vector<std::optional<Descriptor>> descriptors(corners.size());
  for (std::size_t octave = 0; octave < pyramid.size(); ++octave) {
    const PyramidLevel& level = pyramid[octave];
    std::vector<std::size_t> of;  // the corners that the pixels belong to
    std::vector<OrientedPixel> pixels;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i].octave != static_cast<int>(octave)) continue;
      const Eigen::Vector2d px = level.FromFull(corners[i].px).array().round();
      if (px.minCoeff() < kOrbReach || px.x() + kOrbReach >= level.image.width() ||
          px.y() + kOrbReach >= level.image.height()) {
        continue;
      }
      of.push_back(i);
      pixels.push_back({static_cast<int>(px.x()), static_cast<int>(px.y()), corners[i].angle});
    }
    const std::vector<Descriptor> described = DescribeOrb(level.image, pixels);
    for (std::size_t k = 0; k < of.size(); ++k) descriptors[of[k]] = described[k];
  }
  return descriptors;
}

ImagePyramid BuildOrbPyramid(const GrayImage& image, const OrbOptions& options) {
  return BuildPyramid(image, kLevels, options.scale_factor);
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
  // Points that a level cannot provide are taken from the levels above it.
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

std::vector<RemovedOption> RemovedOptions(std::type_identity<OrbOptions> /*of*/) {
  return {FixedAt("sigma_px", kCornerSigmaPx, "kCornerSigmaPx"),
          FixedAt("noise_sigma_px", kCornerNoiseSigmaPx, "kCornerNoiseSigmaPx")};
}

}  // namespace plumbline
