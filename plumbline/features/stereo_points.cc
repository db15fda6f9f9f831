// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/parallel.h"
#include "plumbline/base/statistics.h"
#include "plumbline/features/match_points.h"
#include "plumbline/features/row_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace plumbline {
namespace {

constexpr int kMaxWindow = 15;
// Largest ratio of the best sum of differences to the second best elsewhere in the row. Repeated
// texture is above it.
constexpr double kMaxRatio = 0.9;
// Least deviation of a disparity on the level image, below which sampling errors are not known.
constexpr double kMinSigmaPx = 0.08;
constexpr std::size_t kMaxPatch =
    static_cast<std::size_t>((2 * kMaxWindow + 1) * (2 * kMaxWindow + 1));

// A square of grey levels without their mean.
struct Patch {
  std::array<float, kMaxPatch> value;
};

bool ReadPatch(const GrayImage& image, int x, int y, int half, Patch* patch) {
  if (x < half || y < half || x >= image.width() - half || y >= image.height() - half) return false;
  const int side = 2 * half + 1;
  float* out = patch->value.data();
  int sum = 0;
  for (int dy = -half; dy <= half; ++dy) {
    const std::uint8_t* row = image.row(y + dy) + x - half;
    for (int dx = 0; dx < side; ++dx) {
      sum += row[dx];
      *out++ = static_cast<float>(row[dx]);
    }
  }
  const float mean = static_cast<float>(sum) / static_cast<float>(side * side);
  for (int i = 0; i < side * side; ++i) patch->value[static_cast<std::size_t>(i)] -= mean;
  return true;
}

struct Correlation {
  double x = 0;         // place in the right level image
  double sigma = 1;     // deviation of x, level pixels
  double residual = 0;  // mean absolute difference, grey levels
};

// The weights of a window's pixels: a Gaussian, since pixels far from the corner are more likely to
// be at another depth. For the same reason the windows of coarse levels, which cover more of the
// scene, have fewer pixels, by the square root of the level's scale.
class CorrelationWindow {
 public:
  CorrelationWindow(int finest_half, double scale)
      : half_(std::max(std::min(finest_half, kMinHalf),
                       static_cast<int>(std::lround(finest_half / std::sqrt(scale))))) {
    constexpr double kSigmaOverHalf = 0.5;
    const double sigma = kSigmaOverHalf * half_;
    std::size_t k = 0;
    for (int dy = -half_; dy <= half_; ++dy) {
      for (int dx = -half_; dx <= half_; ++dx, ++k) {
        weight_[k] = static_cast<float>(math::Exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma)));
        total_ += weight_[k];
      }
    }
  }

  int half() const { return half_; }
  float total() const { return total_; }
  float operator[](std::size_t k) const { return weight_[k]; }

 private:
  static constexpr int kMinHalf = 3;

  std::array<float, kMaxPatch> weight_;
  int half_;
  float total_ = 0;
};

// One Gauss-Newton step for the shift along x, with the mean brightness free. The numbers are
// weighted sums over the window.
struct ShiftStep {
  double delta = 0;
  double curvature = 0;  // sum of squared derivatives
  double squares = 0;    // sum of squared residuals
  double absolute = 0;   // sum of the magnitudes of residuals
};

std::optional<ShiftStep> StepAt(
    const Patch& left, const CorrelationWindow& window, const GrayImage& right, double x, int y) {
  const int half = window.half();
  const int side = 2 * half + 1;
  const int x0 = static_cast<int>(std::floor(x));
  if (x0 < half + 1 || x0 + half + 2 >= right.width()) return std::nullopt;
  const auto f = static_cast<float>(x - x0);
  std::array<float, kMaxPatch> residual;
  std::array<float, kMaxPatch> slope;
  float mean_r = 0;
  float mean_g = 0;
  std::size_t k = 0;
  for (int dy = -half; dy <= half; ++dy) {
    const std::uint8_t* row = right.row(y + dy) + x0 - half;
    for (int dx = 0; dx < side; ++dx, ++k) {
      const auto a = static_cast<float>(row[dx]);
      const auto b = static_cast<float>(row[dx + 1]);
      const auto before = static_cast<float>(row[dx - 1]);
      const auto after = static_cast<float>(row[dx + 2]);
      residual[k] = left.value[k] - (a + f * (b - a));
      slope[k] = 0.5F * ((1 - f) * (b - before) + f * (after - a));
      mean_r += window[k] * residual[k];
      mean_g += window[k] * slope[k];
    }
  }
  mean_r /= window.total();
  mean_g /= window.total();
  ShiftStep step;
  double moment = 0;
  for (std::size_t i = 0; i < k; ++i) {
    const float r = residual[i] - mean_r;
    const float g = slope[i] - mean_g;
    const float wr = window[i] * r;
    const float wg = window[i] * g;
    moment += static_cast<double>(wr * g);
    step.curvature += static_cast<double>(wg * g);
    step.squares += static_cast<double>(wr * r);
    step.absolute += static_cast<double>(std::abs(wr));
  }
  if (step.curvature < 1e-3 * static_cast<double>(window.total())) return std::nullopt;
  step.delta = moment / step.curvature;
  return step;
}

std::optional<Correlation> RefineShift(
    const Patch& left, const CorrelationWindow& window, const GrayImage& right, int x, int y) {
  double place = x;
  std::optional<ShiftStep> step;
  for (int iteration = 0; iteration < 6; ++iteration) {
    step = StepAt(left, window, right, place, y);
    if (!step) return std::nullopt;
    place += step->delta;
    if (std::abs(place - x) > 1.5) return std::nullopt;
    if (std::abs(step->delta) < 0.01) break;
  }
  const auto total = static_cast<double>(window.total());
  // Residuals of neighbours are correlated, so that only about every fourth pixel tells something
  // new.
  constexpr double kCorrelated = 4;
  return Correlation{place,
                     std::sqrt(kCorrelated * step->squares / total / step->curvature),
                     step->absolute / total};
}

struct Found {
  Disparity disparity;
  double residual = 0;  // grey levels
};

// Matches the points of one octave: common data, and the search for each point.
class OctaveMatcher {
 public:
  OctaveMatcher(const RectifiedCamera& camera,
                const PyramidLevel& left,
                const PyramidLevel& right,
                const ValidRegion& right_valid,
                const StereoPointOptions& options)
      : left_(left),
        right_(right),
        right_valid_(right_valid),
        window_(options.window_px, left.scale.maxCoeff()),
        search_(left.image, right.image),
        max_disparity_(camera.DisparityFromDepth(options.min_depth_m)),
        calibration_sigma_px_(options.calibration_sigma * camera.width) {}

  std::optional<Found> Match(const PointFeature& point) {
    const double scale = left_.scale.x();
    const Eigen::Vector2i at = left_.FromFull(point.px).array().round().cast<int>();
    const auto range =
        static_cast<int>(std::ceil(std::min<double>(max_disparity_ / scale, left_.image.width())));
    const std::optional<int> x = search_.Find(at, range, kMaxRatio);
    if (!x || !IsReal({*x, at.y()})) return std::nullopt;
    Patch patch;
    if (!ReadPatch(left_.image, at.x(), at.y(), window_.half(), &patch)) return std::nullopt;
    const std::optional<Correlation> found = RefineShift(patch, window_, right_.image, *x, at.y());
    if (!found) return std::nullopt;
    const double disparity = (at.x() - found->x) * scale;
    if (disparity <= 0 || disparity > max_disparity_) return std::nullopt;
    const double sigma =
        math::Hypot(std::max(kMinSigmaPx, found->sigma) * scale, calibration_sigma_px_);
    return Found{{disparity, sigma}, found->residual};
  }

 private:
  // Returns true if the window around a pixel of the right level has only pixels that the camera
  // saw.
  bool IsReal(const Eigen::Vector2i& at) const {
    // Pixels by which refinement may move the window, and their neighbours.
    constexpr int kRefinement = 3;
    const int radius = std::max(window_.half() + kRefinement, RowSearch::kReach);
    return right_valid_.Contains(right_.ToFull(at.cast<double>()),
                                 radius * right_.scale.maxCoeff());
  }

  const PyramidLevel& left_;
  const PyramidLevel& right_;
  const ValidRegion& right_valid_;
  CorrelationWindow window_;
  RowSearch search_;
  double max_disparity_;
  double calibration_sigma_px_;
};

void DropPoorResiduals(std::vector<std::optional<Found>>* matches) {
  constexpr double kAlwaysGood = 3;  // grey levels
  constexpr double kPoor = 4;        // factor on the median
  std::vector<double> residuals;
  for (const std::optional<Found>& match : *matches) {
    if (match) residuals.push_back(match->residual);
  }
  if (residuals.empty()) return;
  const double limit = std::max(kAlwaysGood, kPoor * UpperMedian(std::span<double>(residuals)));
  for (std::optional<Found>& match : *matches) {
    if (match && match->residual > limit) match.reset();
  }
}

}  // namespace

std::vector<std::optional<Disparity>> MatchStereoPoints(const RectifiedCamera& camera,
                                                        const std::vector<PointFeature>& points,
                                                        const StereoPyramids& pyramids,
                                                        const StereoPointOptions& options,
                                                        HelperThread* helper) {
  const ImagePyramid& left = pyramids.left;
  const ImagePyramid& right = pyramids.right;
  PLUMBLINE_CHECK(camera.baseline > 0, "stereo needs a baseline");
  PLUMBLINE_CHECK(left.size() == right.size(), "pyramids of one kind");
  PLUMBLINE_CHECK(options.window_px > 0 && options.window_px <= kMaxWindow,
                  "size of the correlation window");
  std::vector<std::optional<Found>> matches(points.size());
  ParallelFor(static_cast<int>(left.size()), helper, [&](int octave) {
    const auto level = static_cast<std::size_t>(octave);
    const auto in_octave = [&](const PointFeature& point) { return point.octave == octave; };
    if (std::none_of(points.begin(), points.end(), in_octave)) return;
    OctaveMatcher matcher(camera, left[level], right[level], pyramids.right_valid, options);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (in_octave(points[i])) matches[i] = matcher.Match(points[i]);
    }
  });
  DropPoorResiduals(&matches);
  std::vector<std::optional<Disparity>> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (matches[i]) result[i] = matches[i]->disparity;
  }
  return result;
}

}  // namespace plumbline
