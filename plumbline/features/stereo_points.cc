// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/median.h"
#include "plumbline/features/match_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

namespace plumbline {
namespace {

constexpr int kMaxWindow = 15;
constexpr std::size_t kMaxPatch =
    static_cast<std::size_t>((2 * kMaxWindow + 1) * (2 * kMaxWindow + 1));

// Right points ordered by row, to find those of a band of rows.
class RowIndex {
 public:
  explicit RowIndex(const std::vector<PointFeature>& points)
      : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return Row(a) < Row(b); });
  }

  // Calls visit(index) for the points with |y - row| <= band.
  template <class Visit>
  void ForEach(double row, double band, Visit visit) const {
    auto it = std::lower_bound(
        order_.begin(), order_.end(), row - band, [&](int i, double y) { return Row(i) < y; });
    for (; it != order_.end() && Row(*it) <= row + band; ++it) visit(*it);
  }

 private:
  double Row(int i) const { return points_[static_cast<std::size_t>(i)].px.y(); }

  const std::vector<PointFeature>& points_;
  std::vector<int> order_;
};

struct Candidate {
  int index = -1;
  int distance = 257;
};

// May these two show one point? Rows, octaves, disparity.
struct StereoGate {
  const ImagePyramid& pyramid;
  double max_disparity = 0;
  double row_band = 0;

  double Scale(const PointFeature& point) const {
    return pyramid[static_cast<std::size_t>(point.octave)].scale.maxCoeff();
  }

  bool operator()(const PointFeature& left, const PointFeature& right) const {
    const double disparity = left.px.x() - right.px.x();
    const double scale = std::max(Scale(left), Scale(right));
    return std::abs(left.octave - right.octave) <= 1 && disparity >= -scale &&
           disparity <= max_disparity + scale &&
           std::abs(left.px.y() - right.px.y()) <= row_band * scale;
  }
};

// Best right point for a left one, unless another one elsewhere is about as good.
Candidate BestRight(const PointFeature& left,
                    const std::vector<PointFeature>& right,
                    const RowIndex& rows,
                    const StereoGate& gate,
                    const StereoPointOptions& options) {
  constexpr double kSamePlacePx = 4;
  constexpr double kMaxScaleRatio = 2;  // of neighbouring octaves
  Candidate best;
  std::vector<Candidate> all;
  const double scale = gate.Scale(left);
  const double band = gate.row_band * kMaxScaleRatio * scale;
  rows.ForEach(left.px.y(), band, [&](int i) {
    const PointFeature& candidate = right[static_cast<std::size_t>(i)];
    if (!gate(left, candidate)) return;
    const int distance = HammingDistance(left.descriptor, candidate.descriptor);
    all.push_back({i, distance});
    if (distance < best.distance || (distance == best.distance && i < best.index)) {
      best = {i, distance};
    }
  });
  if (best.index < 0 || best.distance > options.max_distance) return {};
  const double place = right[static_cast<std::size_t>(best.index)].px.x();
  for (const Candidate& c : all) {
    const double apart = std::abs(right[static_cast<std::size_t>(c.index)].px.x() - place);
    if (apart > kSamePlacePx * scale && best.distance > options.ratio * c.distance) {
      return {};
    }
  }
  return best;
}

// A square of grey levels with its mean taken off.
struct Patch {
  std::array<float, kMaxPatch> value;
  int half = 0;
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
  patch->half = half;
  return true;
}

float SumOfDifferences(const Patch& a, const Patch& b) {
  const int count = (2 * a.half + 1) * (2 * a.half + 1);
  float sum = 0;
  for (int i = 0; i < count; ++i) {
    sum += std::abs(a.value[static_cast<std::size_t>(i)] - b.value[static_cast<std::size_t>(i)]);
  }
  return sum;
}

struct Correlation {
  double x = 0;         // place in the right level image
  double sigma = 1;     // of x, level pixels
  double residual = 0;  // mean absolute difference, grey levels
};

// Weights of a window's pixels: a Gaussian, since what is far from the corner is more likely to be
// at another depth. For the same reason the windows of coarse levels, which take in more of the
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
        weight_[k] = static_cast<float>(std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma)));
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

// One Gauss-Newton step for the shift along x with the mean brightness free. Sums over the window,
// weighted.
struct ShiftStep {
  double delta = 0;
  double curvature = 0;  // squared derivatives
  double squares = 0;    // squared residuals
  double absolute = 0;   // magnitudes of residuals
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
  // Residuals of neighbours are correlated: about every fourth pixel tells something new.
  constexpr double kCorrelated = 4;
  return Correlation{place,
                     std::sqrt(kCorrelated * step->squares / total / step->curvature),
                     step->absolute / total};
}

// Whole-pixel search along the row, then sub-pixel. nullopt at the end of the search range.
std::optional<Correlation> Correlate(const GrayImage& left,
                                     const Eigen::Vector2i& at,
                                     const GrayImage& right,
                                     int right_x,
                                     const CorrelationWindow& window,
                                     int search_px) {
  Patch reference;
  if (!ReadPatch(left, at.x(), at.y(), window.half(), &reference)) return std::nullopt;
  int best_shift = 0;
  float best = 0;
  bool found = false;
  Patch other;
  for (int shift = -search_px; shift <= search_px; ++shift) {
    if (!ReadPatch(right, right_x + shift, at.y(), window.half(), &other)) continue;
    const float sum = SumOfDifferences(reference, other);
    if (found && sum >= best) continue;
    best = sum;
    best_shift = shift;
    found = true;
  }
  if (!found || std::abs(best_shift) == search_px) return std::nullopt;
  return RefineShift(reference, window, right, right_x + best_shift, at.y());
}

// Index of the left point that each right point likes best, -1: none.
std::vector<int> BestLeft(const std::vector<PointFeature>& left,
                          const std::vector<Candidate>& candidates,
                          std::size_t right_count) {
  std::vector<int> best(right_count, -1);
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Candidate& c = candidates[i];
    if (c.index < 0) continue;
    int& holder = best[static_cast<std::size_t>(c.index)];
    if (holder < 0 || c.distance < candidates[static_cast<std::size_t>(holder)].distance) {
      holder = static_cast<int>(i);
    }
  }
  return best;
}

void DropPoorResiduals(const std::vector<double>& residuals,
                       double factor,
                       std::vector<std::optional<Disparity>>* disparities) {
  constexpr double kAlwaysGood = 3;  // grey levels
  std::vector<double> found;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if ((*disparities)[i]) found.push_back(residuals[i]);
  }
  if (found.empty()) return;
  const double limit = std::max(kAlwaysGood, factor * UpperMedian(std::span<double>(found)));
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i] > limit) (*disparities)[i].reset();
  }
}

}  // namespace

std::vector<std::optional<Disparity>> MatchStereoPoints(const RectifiedCamera& camera,
                                                        const StereoView& left,
                                                        const StereoView& right,
                                                        const StereoPointOptions& options) {
  PLUMBLINE_CHECK(camera.baseline > 0, "stereo needs a baseline");
  PLUMBLINE_CHECK(left.pyramid.size() == right.pyramid.size(), "pyramids of one kind");
  PLUMBLINE_CHECK(options.window_px <= kMaxWindow, "size of the correlation window");
  const StereoGate gate{
      left.pyramid, camera.DisparityFromDepth(options.min_depth_m), options.row_band_px};
  const double calibration_sigma_px = options.calibration_sigma * camera.width;
  std::vector<CorrelationWindow> windows;
  for (const PyramidLevel& level : left.pyramid) {
    windows.emplace_back(options.window_px, level.scale.maxCoeff());
  }
  const RowIndex rows(right.points);
  std::vector<Candidate> candidates(left.points.size());
  for (std::size_t i = 0; i < left.points.size(); ++i) {
    candidates[i] = BestRight(left.points[i], right.points, rows, gate, options);
  }
  const std::vector<int> best_left = BestLeft(left.points, candidates, right.points.size());
  std::vector<std::optional<Disparity>> result(left.points.size());
  std::vector<double> residuals(left.points.size(), 0);
  for (std::size_t i = 0; i < left.points.size(); ++i) {
    if (candidates[i].index < 0) continue;
    const auto j = static_cast<std::size_t>(candidates[i].index);
    const auto octave = static_cast<std::size_t>(left.points[i].octave);
    if (best_left[j] != static_cast<int>(i)) continue;
    const PyramidLevel& level = left.pyramid[octave];
    const PyramidLevel& other = right.pyramid[octave];
    const Eigen::Vector2i at = level.FromFull(left.points[i].px).array().round().cast<int>();
    const double start = other.FromFull(right.points[j].px).x();
    const std::optional<Correlation> found = Correlate(level.image,
                                                       at,
                                                       other.image,
                                                       static_cast<int>(std::lround(start)),
                                                       windows[octave],
                                                       options.search_px);
    if (!found) continue;
    const double disparity = (at.x() - found->x) * level.scale.x();
    if (disparity <= 0 || disparity > gate.max_disparity) continue;
    const double sigma = std::hypot(std::max(options.min_sigma_px, found->sigma) * level.scale.x(),
                                    calibration_sigma_px);
    result[i] = Disparity{disparity, sigma};
    residuals[i] = found->residual;
  }
  DropPoorResiduals(residuals, options.max_sad_factor, &result);
  return result;
}

}  // namespace plumbline
