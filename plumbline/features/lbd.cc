// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/lbd.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/processor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace plumbline {
namespace {

// Rows of samples parallel to the line are two pixels apart, since the smoothed gradient has no
// more detail.
constexpr int kRowStep = 2;
constexpr int kRows = (kLbdBands * kLbdBandWidth + kRowStep - 1) / kRowStep;
// There is one sample along the line for each pixel, and fewer on longer lines.
constexpr int kMaxColumns = 96;
// Units of fixed point numbers: of directions, and of pixel coordinates (16 bits below the point).
constexpr int kUnit = 256;
constexpr double kOne = 65536;

// Returns the distance of a row or a band from the line, across it, in pixels.
constexpr double RowOffset(int row) { return kRowStep * (row - 0.5 * (kRows - 1)); }
constexpr double BandOffset(int band) { return kLbdBandWidth * (band - 0.5 * (kLbdBands - 1)); }

// The rows that belong to a band and its two neighbours, and their weights (section 3.1 of the
// paper): a Gaussian over the whole region, whose deviation is half the width of the region, times
// one over the three bands, whose deviation is one band.
struct BandWeights {
  std::size_t begin = kRows;
  std::size_t end = 0;
  std::array<float, kRows> weight{};
};

std::array<BandWeights, kLbdBands> MakeWeights() {
  constexpr double kGlobalSigma = 0.5 * (kLbdBands * kLbdBandWidth - 1);
  constexpr double kLocalSigma = kLbdBandWidth;
  std::array<BandWeights, kLbdBands> bands;
  for (int b = 0; b < kLbdBands; ++b) {
    BandWeights& band = bands[static_cast<std::size_t>(b)];
    for (int row = 0; row < kRows; ++row) {
      const double global = RowOffset(row) / kGlobalSigma;
      const double local = (RowOffset(row) - BandOffset(b)) / kLocalSigma;
      if (std::abs(local) > 1.5) continue;
      const auto r = static_cast<std::size_t>(row);
      band.begin = std::min(band.begin, r);
      band.end = r + 1;
      band.weight[r] = static_cast<float>(math::Exp(-0.5 * (global * global + local * local)));
    }
  }
  return bands;
}

// The means over a row of samples of the positive and of the negative part of the gradient, first
// across the line, then along it.
using RowSums = std::array<float, 4>;
using RegionSums = std::array<RowSums, kRows>;

// The first place of a row of samples and the step between places, in fixed point.
struct RowOfSamples {
  std::int64_t x, y, step_x, step_y;
  std::size_t size;
};

// The samples of one row.
struct RowSamples {
  std::array<std::int16_t, kMaxColumns> dx;
  std::array<std::int16_t, kMaxColumns> dy;
};

// Takes a row that is all inside an image with sides of less than 2^15 pixels. Several places are
// computed at once, which is not possible for reading the pixels.
struct TakeInside {
  [[gnu::always_inline]] static inline void Run(const GradientImage& gradient,
                                                const RowOfSamples& row,
                                                RowSamples* samples) {
    const auto x = static_cast<std::int32_t>(row.x);
    const auto y = static_cast<std::int32_t>(row.y);
    const auto step_x = static_cast<std::int32_t>(row.step_x);
    const auto step_y = static_cast<std::int32_t>(row.step_y);
    const std::int32_t width = gradient.width();
    std::array<std::int32_t, kMaxColumns> places;
    const auto size = static_cast<std::int32_t>(row.size);
    for (std::int32_t n = 0; n < size; ++n) {
      places[static_cast<std::size_t>(n)] =
          ((y + n * step_y) >> 16) * width + ((x + n * step_x) >> 16);
    }
    const std::int16_t* dx = gradient.dx.data();
    const std::int16_t* dy = gradient.dy.data();
    for (std::size_t n = 0; n < row.size; ++n) {
      samples->dx[n] = dx[places[n]];
      samples->dy[n] = dy[places[n]];
    }
  }
};

// Takes a row that is partly outside the image, whose border is continued there. Returns false when
// all of the row is outside.
bool TakeAcrossBorder(const GradientImage& gradient, RowOfSamples row, RowSamples* samples) {
  bool any = false;
  const std::int64_t width = gradient.width();
  const std::int64_t height = gradient.height();
  for (std::size_t n = 0; n < row.size; ++n, row.x += row.step_x, row.y += row.step_y) {
    const std::int64_t near_x = std::clamp<std::int64_t>(row.x >> 16, 0, width - 1);
    const std::int64_t near_y = std::clamp<std::int64_t>(row.y >> 16, 0, height - 1);
    any = any || (near_x == row.x >> 16 && near_y == row.y >> 16);
    samples->dx[n] = gradient.dx.data()[near_y * width + near_x];
    samples->dy[n] = gradient.dy.data()[near_y * width + near_x];
  }
  return any;
}

// Takes samples at `size` places from `first` on. Returns false when all are outside the image.
bool TakeSamples(const GradientImage& gradient,
                 const Eigen::Vector2d& first,
                 const Eigen::Vector2d& step,
                 std::size_t size,
                 RowSamples* samples) {
  constexpr int kLargestSide = 1 << 15;
  const Eigen::Vector2d last = first + static_cast<double>(size - 1) * step;
  const Eigen::Array2d limit(gradient.width() - 0.75, gradient.height() - 0.75);
  const auto inside = [&](const Eigen::Vector2d& px) {
    return (px.array() > -0.25).all() && (px.array() < limit).all();
  };
  const RowOfSamples row{static_cast<std::int64_t>((first.x() + 0.5) * kOne),
                         static_cast<std::int64_t>((first.y() + 0.5) * kOne),
                         static_cast<std::int64_t>(step.x() * kOne),
                         static_cast<std::int64_t>(step.y() * kOne),
                         size};
  if (!inside(first) || !inside(last) ||
      std::max(gradient.width(), gradient.height()) >= kLargestSide) {
    return TakeAcrossBorder(gradient, row, samples);
  }
  RunBest<TakeInside>(gradient, row, samples);
  return true;
}

// Sums samples in whole numbers, so that the compiler may add in any order and use vector
// instructions.
struct SumSamples {
  [[gnu::always_inline]] static inline RowSums Run(const RowSamples& samples,
                                                   std::size_t size,
                                                   std::int16_t direction_x,
                                                   std::int16_t direction_y) {
    int across_sum = 0;
    int across_size = 0;
    int along_sum = 0;
    int along_size = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const int across = samples.dy[i] * direction_x - samples.dx[i] * direction_y;
      const int along = samples.dx[i] * direction_x + samples.dy[i] * direction_y;
      across_sum += across;
      across_size += std::abs(across);
      along_sum += along;
      along_size += std::abs(along);
    }
    // The sums of the positive and of the negative parts follow from the sum and the sum of
    // magnitudes.
    const float scale = 0.5F / static_cast<float>(kUnit * static_cast<int>(size));
    return {scale * static_cast<float>(across_size + across_sum),
            scale * static_cast<float>(across_size - across_sum),
            scale * static_cast<float>(along_size + along_sum),
            scale * static_cast<float>(along_size - along_sum)};
  }
};

// Sums the rows of the region. Returns false when all of it is outside the image.
bool SumRows(const GradientImage& gradient, const Segment2& segment, RegionSums* sums) {
  RowSamples samples;
  const double length = segment.Length();
  const Eigen::Vector2d direction = segment.Direction();
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  const int columns = std::clamp(static_cast<int>(std::ceil(length)), 1, kMaxColumns);
  const auto size = static_cast<std::size_t>(columns);
  const Eigen::Vector2d step = direction * (length / columns);
  const auto direction_x = static_cast<std::int16_t>(std::lround(kUnit * direction.x()));
  const auto direction_y = static_cast<std::int16_t>(std::lround(kUnit * direction.y()));
  bool any = false;
  for (int row = 0; row < kRows; ++row) {
    // The samples of one row lie between those of the next row.
    const double shift = row % 2 == 0 ? 0.25 : 0.75;
    const Eigen::Vector2d first = segment.start + shift * step + RowOffset(row) * normal;
    any = TakeSamples(gradient, first, step, size, &samples) || any;
    (*sums)[static_cast<std::size_t>(row)] =
        RunBest<SumSamples>(samples, size, direction_x, direction_y);
  }
  return any;
}

// Scales the entries first, first + 8 * i + k (k < 4) of all bands to unit norm, and limits large
// ones.
void Normalize(LbdVector* vector, std::size_t first) {
  constexpr float kLimit = 0.4F;
  for (int pass = 0; pass < 2; ++pass) {
    float squares = 0;
    for (std::size_t i = first; i < vector->size(); i += 8) {
      for (std::size_t k = 0; k < 4; ++k) squares += (*vector)[i + k] * (*vector)[i + k];
    }
    if (squares <= 0) return;
    const float scale = 1 / std::sqrt(squares);
    for (std::size_t i = first; i < vector->size(); i += 8) {
      for (std::size_t k = 0; k < 4; ++k) {
        float& v = (*vector)[i + k];
        v *= scale;
        if (pass == 0) v = std::min(v, kLimit);
      }
    }
  }
}

}  // namespace

LbdVector ComputeLbdVector(const GradientImage& gradient, const Segment2& segment) {
  static const std::array<BandWeights, kLbdBands> kWeights = MakeWeights();
  LbdVector result{};
  const double length = segment.Length();
  // A line of this length has left every image. The limit also keeps the pixel coordinates inside
  // int.
  if (!(length > 0) || !(length < 1e6) || !(segment.start.norm() < 1e6)) return result;
  RegionSums sums;
  if (!SumRows(gradient, segment, &sums)) return result;
  for (std::size_t b = 0; b < kLbdBands; ++b) {
    const BandWeights& band = kWeights[b];
    std::array<float, 4> sum{};
    std::array<float, 4> squares{};
    for (std::size_t row = band.begin; row < band.end; ++row) {
      for (std::size_t k = 0; k < 4; ++k) {
        const float v = band.weight[row] * sums[row][k];
        sum[k] += v;
        squares[k] += v * v;
      }
    }
    const float scale = 1 / static_cast<float>(band.end - band.begin);
    for (std::size_t k = 0; k < 4; ++k) {
      const float mean = scale * sum[k];
      const float variance = std::max(0.0F, scale * squares[k] - mean * mean);
      result[8 * b + k] = mean;
      result[8 * b + 4 + k] = std::sqrt(variance);
    }
  }
  Normalize(&result, 0);
  Normalize(&result, 4);
  return result;
}

Descriptor BinarizeLbd(const LbdVector& vector) {
  // All pairs of the 9 bands are compared in order, except 4 pairs of far bands, which see the
  // least of the line.
  Descriptor descriptor{};
  std::size_t bit = 0;
  for (std::size_t a = 0; a < kLbdBands; ++a) {
    for (std::size_t b = a + 1; b < kLbdBands; ++b) {
      if (b - a >= 7 || (b - a == 6 && a == 1)) continue;
      for (std::size_t k = 0; k < 8; ++k, ++bit) {
        descriptor[bit / 64] |= std::uint64_t{vector[8 * a + k] > vector[8 * b + k]} << (bit % 64);
      }
    }
  }
  return descriptor;
}

void DescribeLines(const GradientImage& gradient, std::vector<LineFeature>* lines) {
  for (LineFeature& line : *lines) {
    line.descriptor = BinarizeLbd(ComputeLbdVector(gradient, line.segment));
  }
}

}  // namespace plumbline
