// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/row_search.h"

#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#else
#include <array>
#endif

namespace plumbline {
namespace {

// A row of a window is sixteen bytes, which is one vector instruction's worth.
constexpr int kWindowWidth = 2 * RowSearch::kReach;
constexpr int kBefore = RowSearch::kReach;  // pixels of a window left of its place
constexpr int kHalfHeight = 5;
constexpr int kNone = 128;  // value of a pixel without slope

struct SlopesOfRow {
  // Computes the slopes of pixels 1 to width - 2.
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* above,
                                                const std::uint8_t* row,
                                                const std::uint8_t* below,
                                                int width,
                                                std::uint8_t* slopes) {
    ForBlocks<32>(
        width - 2, [&](int first, auto size) __attribute__((always_inline)) {
          std::uint8_t block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i + 1;
            const auto right =
                static_cast<std::int16_t>(above[x + 1] + 2 * row[x + 1] + below[x + 1]);
            const auto left =
                static_cast<std::int16_t>(above[x - 1] + 2 * row[x - 1] + below[x - 1]);
            // Half of the difference is rounded to the nearest number, ties to even.
            const auto twice = static_cast<std::int16_t>(right - left + 2 * kNone);
            const auto half = static_cast<std::int16_t>(twice >> 1);
            const auto odd = static_cast<std::int16_t>(twice & half & 1);
            const auto rounded = static_cast<std::int16_t>(half + odd);
            const std::int16_t positive = rounded < 0 ? std::int16_t{0} : rounded;
            block[i] = static_cast<std::uint8_t>(positive > 255 ? std::int16_t{255} : positive);
          }
          std::memcpy(slopes + first + 1, block, size);
        });
  }
};

// Returns the derivative along the row, smoothed over three rows (Sobel) and halved; kNone for
// zero. It saturates if grey levels two pixels apart differ by more than 64. The image is reflected
// at its border, so that its first and last column have no slope.
GrayImage Slopes(const GrayImage& image) {
  const int width = image.width();
  const int last = image.height() - 1;
  GrayImage result(width, image.height());
  for (int y = 0; y <= last; ++y) {
    const std::uint8_t* above = image.row(y > 0 ? y - 1 : std::min(1, last));
    const std::uint8_t* below = image.row(y < last ? y + 1 : std::max(0, last - 1));
    std::uint8_t* slopes = result.row(y);
    slopes[0] = slopes[width - 1] = kNone;
    RunBest<SlopesOfRow>(above, image.row(y), below, width, slopes);
  }
  return result;
}

// The pixels of a window in vectors of sixteen bytes.
class Window {
 public:
  // `first` is the window's first pixel in an image of this width.
  [[gnu::always_inline]] inline Window(const std::uint8_t* first, std::ptrdiff_t width) {
    for (int row = 0; row < kWindowHeight; ++row) rows_[row] = Load(first + row * width);
  }

  // Returns the sum of absolute differences from another window over every second row from kFirst
  // on.
  template <int kFirst>
  [[gnu::always_inline]] inline int SumOfDifferences(const std::uint8_t* first,
                                                     std::ptrdiff_t width) const {
    Sums sums{};
#pragma GCC unroll 6
    for (int row = kFirst; row < kWindowHeight; row += 2) {
      Add(rows_[row], Load(first + row * width), sums);
    }
    return Total(sums);
  }

 private:
  static constexpr int kWindowHeight = 2 * kHalfHeight + 1;

#if defined(__SSE2__)
  using Row = __m128i;
  using Sums = __m128i;
  [[gnu::always_inline]] static inline Row Load(const std::uint8_t* bytes) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes));
  }
  [[gnu::always_inline]] static inline void Add(Row a, Row b, Sums& sums) {
    sums = _mm_add_epi32(sums, _mm_sad_epu8(a, b));
  }
  [[gnu::always_inline]] static inline int Total(Sums sums) {
    return _mm_cvtsi128_si32(sums) + _mm_cvtsi128_si32(_mm_srli_si128(sums, 8));
  }
#else
  using Row = std::array<std::uint8_t, kWindowWidth>;
  using Sums = int;
  static Row Load(const std::uint8_t* bytes) {
    Row row;
    std::copy_n(bytes, row.size(), row.begin());
    return row;
  }
  static void Add(const Row& a, const Row& b, Sums& sums) {
    for (std::size_t i = 0; i < a.size(); ++i) sums += std::abs(a[i] - b[i]);
  }
  static int Total(Sums sums) { return sums; }
#endif

  Row rows_[kWindowHeight];
};

// Computes sums of differences between a window and `count` others, each a pixel further to the
// right in another image of the same width. Windows are given by their first pixels. Sums are exact
// if they are at most 1 / ratio times the least sum. Of larger sums only the part over every second
// row is computed, which already exceeds that.
struct SumDifferences {
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* one,
                                                const std::uint8_t* others,
                                                std::ptrdiff_t width,
                                                double ratio,
                                                int count,
                                                int* sums) {
    const Window window(one, width);
    int least = std::numeric_limits<int>::max();
    int likely = 0;
    for (int k = 0; k < count; ++k) {
      const int sum = window.SumOfDifferences<1>(others + k, width);
      sums[k] = sum;
      if (sum >= least) continue;
      least = sum;
      likely = k;
    }
    // The least of the sums over all rows is at most as large as this one.
    const int bound = least + window.SumOfDifferences<0>(others + likely, width);
    const int limit = static_cast<int>(bound / ratio) + 1;
    for (int k = 0; k < count; ++k) {
      if (sums[k] <= limit) sums[k] += window.SumOfDifferences<0>(others + k, width);
    }
  }
};

// Returns the sum of differences from a window without any slope.
int SumOfSlopes(const GrayImage& slopes, const Eigen::Vector2i& at) {
  int sum = 0;
  for (int dy = -kHalfHeight; dy <= kHalfHeight; ++dy) {
    const std::uint8_t* row = slopes.row(at.y() + dy) + at.x() - kBefore;
    for (int i = 0; i < kWindowWidth; ++i) sum += std::abs(row[i] - kNone);
  }
  return sum;
}

}  // namespace

RowSearch::RowSearch(const GrayImage& left, const GrayImage& right)
    : left_(Slopes(left)), right_(Slopes(right)) {
  PLUMBLINE_CHECK(left.width() == right.width() && left.height() == right.height(),
                  "images of one size");
}

std::optional<int> RowSearch::Find(const Eigen::Vector2i& left, int max_disparity, double ratio) {
  const int y = left.y();
  const std::optional<int> x =
      Best(left_, left, right_, {left.x() - max_disparity, left.x() + 1}, ratio);
  if (!x) return std::nullopt;
  const std::optional<int> back = Best(right_, {*x, y}, left_, {*x - 1, *x + max_disparity}, ratio);
  if (!back || std::abs(*back - left.x()) > 1) return std::nullopt;
  return x;
}

std::optional<int> RowSearch::Best(const GrayImage& from,
                                   const Eigen::Vector2i& at,
                                   const GrayImage& to,
                                   Columns columns,
                                   double ratio) {
  constexpr int kSamePlace = 2;
  const auto fits = [&](int x) { return x >= kBefore && x + kWindowWidth - kBefore <= to.width(); };
  if (at.y() < kHalfHeight || at.y() + kHalfHeight >= to.height() || !fits(at.x())) {
    return std::nullopt;
  }
  const int first = std::max(columns.first, kBefore);
  const int last = std::min(columns.last, to.width() - (kWindowWidth - kBefore));
  if (first > last) return std::nullopt;
  sums_.resize(static_cast<std::size_t>(last - first + 1));
  RunBest<SumDifferences>(from.row(at.y() - kHalfHeight) + at.x() - kBefore,
                          to.row(at.y() - kHalfHeight) + first - kBefore,
                          to.width(),
                          ratio,
                          last - first + 1,
                          sums_.data());
  const auto least = std::min_element(sums_.begin(), sums_.end());
  const auto best = static_cast<int>(least - sums_.begin());
  int second = SumOfSlopes(from, at);
  for (int k = 0; k < static_cast<int>(sums_.size()); ++k) {
    if (std::abs(k - best) > kSamePlace) {
      second = std::min(second, sums_[static_cast<std::size_t>(k)]);
    }
  }
  if (*least >= ratio * second) return std::nullopt;
  return first + best;
}

}  // namespace plumbline
