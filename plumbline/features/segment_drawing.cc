// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/segment_drawing.h"

#include "plumbline/base/processor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <optional>

namespace plumbline {
namespace {

// Width of the border of the image in which no edge is looked for.
constexpr int kBorder = 3;
// Tangent of the largest angle between gradient and normal, as a fraction.
constexpr std::array kMaxTurn{5, 12};
constexpr int kUnit = 256;  // fixed point of slopes
// Largest distance of an edge point from the predicted line, px.
constexpr float kMaxResidual = 1;
constexpr double kMaxScatter = 0.4;  // RMS of all edge points, px
// Least number of edge points on a segment / pixels of its major axis.
constexpr double kMinDensity = 0.75;

// State of a pixel.
enum Mark : std::uint8_t { kFree = 0, kTried = 1, kDrawn = 2 };

// The gradient relative to one axis, for edges that run along this major axis within about 45
// degrees. Such an edge is minor = f(major), and `across` (the derivative along the minor axis) is
// large.
struct AxisView {
  const std::int16_t* across;
  const std::int16_t* along;
  std::ptrdiff_t major_step, minor_step;
  int major_size, minor_size;

  std::ptrdiff_t Index(int major, int minor) const {
    return major * major_step + minor * minor_step;
  }
};

AxisView FlatEdges(const GradientImage& g) {
  return {g.dy.data(), g.dx.data(), 1, g.width(), g.width(), g.height()};
}

AxisView SteepEdges(const GradientImage& g) {
  return {g.dx.data(), g.dy.data(), g.width(), 1, g.height(), g.width()};
}

struct Anchor {
  int x, y;
  bool steep;
  int strength;
};

// Sums for the least squares fit of minor = offset + slope * major, with major relative to the
// anchor.
struct LineSums {
  int n = 0, m = 0;
  std::int64_t mm = 0;
  double v = 0, mv = 0, vv = 0;

  void Add(int major, double minor) {
    n += 1;
    m += major;
    mm += std::int64_t{major} * major;
    v += minor;
    mv += major * minor;
    vv += minor * minor;
  }
};

struct Fit {
  float offset = 0;
  float slope = 0;
  float reach = 0;  // kMaxResidual along the minor axis
  int turn = 0;     // slope times kUnit
  int points = 0;   // number of points that were fitted
  double scatter = 0;
};

Fit FitSums(const LineSums& s) {
  const double n = s.n;
  const double m = s.m;
  const double spread = static_cast<double>(s.mm) - m * m / n;
  const double slope = (s.mv - m * s.v / n) / spread;
  const double offset = (s.v - slope * m) / n;
  const double squares = s.vv - s.v * s.v / n - slope * slope * spread;
  return {static_cast<float>(offset),
          static_cast<float>(slope),
          kMaxResidual * static_cast<float>(std::sqrt(1 + slope * slope)),
          static_cast<int>(slope * kUnit),
          s.n,
          std::sqrt(std::max(0.0, squares / n) / (1 + slope * slope))};
}

// Returns true if the edge seems to continue straight from here, at least on one side: the gradient
// a few pixels further on must have nearly the same direction. This quick test avoids most walks.
bool Promising(const AxisView& view, int major, int minor) {
  constexpr int kAhead = 4;
  const std::ptrdiff_t here = view.Index(major, minor);
  const int across = view.across[here];
  const int along = view.along[here];
  const int slope = kAhead * along / across;
  if (minor - kAhead < kBorder || minor + kAhead >= view.minor_size - kBorder) return true;
  for (const int side : {-1, 1}) {
    const int ahead = major + side * kAhead;
    if (ahead < 0 || ahead >= view.major_size) continue;
    const std::ptrdiff_t i = view.Index(ahead, minor - side * slope);
    const int dot = across * view.across[i] + along * view.along[i];
    const int cross = across * view.along[i] - along * view.across[i];
    if (std::abs(cross) * kMaxTurn[1] <= dot * kMaxTurn[0]) return true;
  }
  return false;
}

// Follows one edge both ways from its anchor.
class Walk {
 public:
  Walk(const AxisView& view, const Image<std::uint8_t>& marks, int min_slope)
      : view_(view), marks_(marks.data()), min_rise_(min_slope * kUnit) {}

  // Returns false when there is no straight edge. `path` receives the index of each edge pixel.
  bool Follow(int major, int minor, std::vector<std::ptrdiff_t>* path) {
    const std::ptrdiff_t i = view_.Index(major, minor);
    const std::ptrdiff_t step = view_.minor_step;
    sign_ = view_.across[i] > 0 ? 1 : -1;
    const auto sum = [&](const std::int16_t* g) {
      return static_cast<float>(g[i - step] + 2 * g[i] + g[i + step]);
    };
    anchor_major_ = major;
    anchor_minor_ = minor;
    const float across = sum(view_.across);
    if (across * static_cast<float>(sign_) <= 0) return false;
    fit_.slope = std::clamp(-sum(view_.along) / across, -1.2F, 1.2F);
    fit_.reach = 1.5F * kMaxResidual;
    fit_.turn = static_cast<int>(fit_.slope * kUnit);
    const std::optional<float> start = EdgeNear(major, 0);
    if (!start) return false;
    last_minor_ = *start;
    AddPoint(major, *start, path);
    last_major_[0] = last_major_[1] = major;
    last_seen_ = major;
    Extend(1, path);
    last_minor_ = *start;
    last_seen_ = major;
    Extend(0, path);
    if (sums_.n < kSeedPoints) return false;
    fit_ = FitSums(sums_);
    return true;
  }

  // Returns the length along the line.
  double Length() const {
    return (last_major_[1] - last_major_[0]) * std::sqrt(1.0 + fit_.slope * fit_.slope);
  }
  double Scatter() const { return fit_.scatter; }
  double Density() const { return sums_.n / (last_major_[1] - last_major_[0] + 1.0); }
  bool Rising() const { return sign_ > 0; }  // true if larger minor coordinates are brighter
  // Returns the end with the smaller (0) or larger (1) major coordinate, as (major, minor).
  Eigen::Vector2d End(int side) const {
    const int major = last_major_[static_cast<std::size_t>(side)];
    return {static_cast<double>(major),
            static_cast<double>(anchor_minor_) + fit_.offset +
                static_cast<double>(fit_.slope) * (major - anchor_major_)};
  }

 private:
  static constexpr int kSeedPoints = 6;
  static constexpr float kMaxSlope = 1.5F;
  // Growth of the number of points after which the line is fitted again.
  static constexpr double kRefitGrowth = 1.25;

  // Returns the minor coordinate, relative to the anchor, of the edge at this major coordinate near
  // `guess`.
  std::optional<float> EdgeNear(int major, float guess) const {
    const int center = Nearest(guess);
    if (center < kBorder || center >= view_.minor_size - kBorder) return std::nullopt;
    const std::ptrdiff_t middle = view_.Index(major, center);
    const std::ptrdiff_t step = view_.minor_step;
    const int turn = fit_.turn;
    // Derivative across the line times kUnit; it is positive at the edge.
    const auto rise = [&](std::ptrdiff_t i) {
      return sign_ * (view_.across[i] * kUnit - turn * view_.along[i]);
    };
    // The largest of three derivatives, and the two beside it.
    int peak = rise(middle);
    int before = rise(middle - step);
    int after = rise(middle + step);
    int shift = 0;
    if (before > peak && before >= after) {
      after = peak;
      peak = before;
      before = rise(middle - 2 * step);
      shift = -1;
    } else if (after > peak) {
      before = peak;
      peak = after;
      after = rise(middle + 2 * step);
      shift = 1;
    }
    if (peak < min_rise_ || peak < before || peak < after) return std::nullopt;
    const std::ptrdiff_t i = middle + shift * step;
    const int turned = view_.along[i] * kUnit + turn * view_.across[i];
    if (std::abs(turned) * kMaxTurn[1] > peak * kMaxTurn[0]) return std::nullopt;
    if (marks_[i] == kDrawn) return std::nullopt;
    const int bend = 2 * peak - before - after;
    const float offset =
        bend > 0 ? 0.5F * static_cast<float>(after - before) / static_cast<float>(bend) : 0.0F;
    const float place = static_cast<float>(center - anchor_minor_ + shift);
    if (std::abs(place + offset - guess) > fit_.reach) return std::nullopt;
    return place + offset;
  }

  void AddPoint(int major, float minor, std::vector<std::ptrdiff_t>* path) {
    sums_.Add(major - anchor_major_, minor);
    path->push_back(view_.Index(major, Nearest(minor)));
  }

  // Returns the minor coordinate of the pixel nearest to a place that is relative to the anchor. It
  // is exact from -1/2 on; for smaller ones it only matters that the result is outside the image.
  int Nearest(float place) const {
    return static_cast<int>(static_cast<float>(anchor_minor_) + place + 0.5F);
  }

  // Walks towards smaller (side 0) or larger (side 1) major coordinates. Every miss is a debt,
  // which points pay back; the points behind a gap count once the debt is paid.
  void Extend(int side, std::vector<std::ptrdiff_t>* path) {
    const int direction = side == 1 ? 1 : -1;
    int& last = last_major_[static_cast<std::size_t>(side)];
    int debt = 0;
    BeforeGap before_gap;
    State before_bend{sums_, fit_, path->size(), last};
    for (int major = last + direction; major >= kBorder && major < view_.major_size - kBorder;
         major += direction) {
      const std::optional<float> edge = EdgeNear(major, Guess(major));
      if (!edge) {
        if (debt == 0) before_gap = {sums_, path->size(), last};
        if (++debt > std::min(sums_.n / kPointsPerMiss, kMaxGap)) break;
        continue;
      }
      last_minor_ = *edge;
      last_seen_ = major;
      AddPoint(major, *edge, path);
      if (debt > 0 && --debt > 0) continue;
      last = major;
      if (sums_.n < kSeedPoints || sums_.n < kRefitGrowth * fit_.points) continue;
      fit_ = FitSums(sums_);
      if (fit_.scatter > kMaxScatter || std::abs(fit_.slope) > kMaxSlope) {
        Restore(before_bend, &last, path);
        return;
      }
      before_bend = {sums_, fit_, path->size(), last};
    }
    if (debt == 0) return;
    sums_ = before_gap.sums;
    path->resize(before_gap.path);
    last = before_gap.last;
  }

  float Guess(int major) const {
    return sums_.n < kSeedPoints
               ? last_minor_ + fit_.slope * static_cast<float>(major - last_seen_)
               : fit_.offset + fit_.slope * static_cast<float>(major - anchor_major_);
  }

  // State before a gap, to which the walk returns if the gap is not overcome. The fit is not
  // included, since it stays the same within a gap.
  struct BeforeGap {
    LineSums sums;
    std::size_t path = 0;
    int last = 0;
  };

  struct State {
    LineSums sums;
    Fit fit;
    std::size_t path = 0;
    int last = 0;
  };

  void Restore(const State& state, int* last, std::vector<std::ptrdiff_t>* path) {
    sums_ = state.sums;
    fit_ = state.fit;
    path->resize(state.path);
    *last = state.last;
  }

  static constexpr int kMaxGap = 8;  // px
  // Points on the line that are needed for each pixel of a gap.
  static constexpr int kPointsPerMiss = 4;

  const AxisView view_;  // a copy, so that the compiler knows that no write changes it
  const std::uint8_t* marks_;
  int min_rise_;
  int sign_ = 1;
  int anchor_major_ = 0;
  int anchor_minor_ = 0;
  Fit fit_;
  LineSums sums_;
  float last_minor_ = 0;
  std::array<int, 2> last_major_{};
  int last_seen_ = 0;
};

int Size(std::int16_t v) { return std::abs(static_cast<int>(v)); }

// Marks with 1 the pixels of a row whose derivative `across` is at least min_strength, not below
// that along the edge, and larger than at both neighbours across, which are `step` pixels before
// and after. The loop is vectorized.
struct MarkMaxima {
  [[gnu::always_inline]] static inline void Run(const std::int16_t* across,
                                                const std::int16_t* along,
                                                std::ptrdiff_t step,
                                                int min_strength,
                                                int count,
                                                std::uint8_t* maxima) {
    const auto least = static_cast<std::int16_t>(min_strength);
    ForBlocks<32>(
        count, [&](int first, auto size) __attribute__((always_inline)) {
          std::uint8_t block[size];
          const auto abs = [](std::int16_t v) { return static_cast<std::int16_t>(v < 0 ? -v : v); };
          for (int i = 0; i < size; ++i) {
            const std::int16_t* at = across + first + i;
            const std::int16_t value = abs(*at);
            block[i] =
                static_cast<std::uint8_t>((value >= least) & (value >= abs(along[first + i])) &
                                          (value >= abs(at[-step])) & (value > abs(at[step])));
          }
          std::memcpy(maxima + first, block, size);
        });
  }
};

// Returns local maxima of the gradient on every `step`-th row (steep edges) and column (flat
// edges).
std::vector<Anchor> FindAnchors(const GradientImage& gradient, int min_strength, int step) {
  std::vector<Anchor> anchors;
  const int width = gradient.width();
  const int count = width - 2 * kBorder;
  std::vector<std::uint8_t> maxima(static_cast<std::size_t>(count));
  for (int y = kBorder; y < gradient.height() - kBorder; ++y) {
    const std::int16_t* dx = gradient.dx.row(y) + kBorder;
    const std::int16_t* dy = gradient.dy.row(y) + kBorder;
    RunBest<MarkMaxima>(dy, dx, width, min_strength, count, maxima.data());
    for (int x = 0; x < count; x += step) {
      if (maxima[static_cast<std::size_t>(x)] == 0) continue;
      anchors.push_back({x + kBorder, y, false, Size(dy[x])});
    }
    if (y % step != 0) continue;
    RunBest<MarkMaxima>(dx, dy, 1, min_strength, count, maxima.data());
    for (int x = 0; x < count; ++x) {
      if (maxima[static_cast<std::size_t>(x)] == 0) continue;
      anchors.push_back({x + kBorder, y, true, Size(dx[x])});
    }
  }
  return anchors;
}

// Returns the anchors with the strongest first, equal ones in order. Sorts by counting, with
// strengths in steps of 1/8 grey level.
std::vector<Anchor> StrongestFirst(const std::vector<Anchor>& anchors) {
  constexpr std::size_t kBins = 1024;
  const auto bin = [](const Anchor& a) {
    return kBins - 1 - std::min(kBins - 1, static_cast<std::size_t>(a.strength));
  };
  std::array<std::size_t, kBins + 1> begin{};
  for (const Anchor& a : anchors) ++begin[bin(a) + 1];
  for (std::size_t i = 0; i < kBins; ++i) begin[i + 1] += begin[i];
  std::vector<Anchor> sorted(anchors.size());
  for (const Anchor& a : anchors) sorted[begin[bin(a)]++] = a;
  return sorted;
}

Segment2 Directed(const Walk& walk, bool steep) {
  const auto place = [&](int side) {
    const Eigen::Vector2d end = walk.End(side);
    return steep ? Eigen::Vector2d(end.y(), end.x()) : end;
  };
  // With y down, a line that runs down has its left side at larger x, one that runs right at
  // smaller y.
  const Segment2 segment{place(0), place(1)};
  return walk.Rising() == steep ? segment : segment.Reversed();
}

}  // namespace

std::vector<Segment2> DrawSegments(const GradientImage& gradient,
                                   double min_length,
                                   double min_gradient) {
  std::vector<Segment2> segments;
  if (std::min(gradient.width(), gradient.height()) <= 2 * kBorder) return segments;
  const int min_slope = std::max(1, static_cast<int>(min_gradient * kSobelGain));
  const std::array<AxisView, 2> views{FlatEdges(gradient), SteepEdges(gradient)};
  Image<std::uint8_t> marks(gradient.width(), gradient.height(), kFree);
  std::vector<std::ptrdiff_t> path;
  // With this step even the shortest segment, at 45 degrees, has two anchors.
  constexpr double kMaxStep = 6;
  const int step =
      static_cast<int>(std::clamp(min_length / (2 * std::numbers::sqrt2), 1.0, kMaxStep));
  for (const Anchor& anchor : StrongestFirst(FindAnchors(gradient, min_slope, step))) {
    if (marks.at(anchor.x, anchor.y) != kFree) continue;
    const AxisView& view = views[anchor.steep ? 1 : 0];
    const int major = anchor.steep ? anchor.y : anchor.x;
    const int minor = anchor.steep ? anchor.x : anchor.y;
    if (!Promising(view, major, minor)) continue;
    path.clear();
    Walk walk(view, marks, min_slope);
    const bool good = walk.Follow(major, minor, &path) && walk.Length() >= min_length &&
                      walk.Scatter() <= kMaxScatter && walk.Density() >= kMinDensity;
    for (const std::ptrdiff_t i : path) {
      std::uint8_t* mark = marks.data() + i;
      if (!good) {
        *mark = std::max<std::uint8_t>(*mark, kTried);
        continue;
      }
      mark[-view.minor_step] = mark[0] = mark[view.minor_step] = kDrawn;
    }
    if (good) segments.push_back(Directed(walk, anchor.steep));
  }
  return segments;
}

}  // namespace plumbline
