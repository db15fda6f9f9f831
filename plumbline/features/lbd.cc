// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/lbd.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr int kRows = kLbdBands * kLbdBandWidth;
constexpr int kMaxColumns = 40;

// Sums over one row of pixels parallel to the line, divided by their number: gradient along the
// normal by sign, gradient along the line by sign.
struct RowSums {
  std::array<double, 4> value{};
  bool valid = false;
};

// Weights across the line (section 3.1 there): a Gaussian over the whole region with deviation half
// its width, and one over a band and its neighbours with deviation of one band.
double GlobalWeight(int row) {
  constexpr double kSigma = 0.5 * (kRows - 1);
  const double d = row - 0.5 * (kRows - 1);
  return std::exp(-0.5 * d * d / (kSigma * kSigma));
}

double LocalWeight(double distance) {
  constexpr double kSigma = kLbdBandWidth;
  return std::exp(-0.5 * distance * distance / (kSigma * kSigma));
}

struct Weights {
  std::array<double, kRows> global{};
  // Of row r for band b, for rows of the band and its two neighbours.
  std::array<std::array<double, kRows>, kLbdBands> local{};
};

Weights MakeWeights() {
  Weights weights;
  for (int row = 0; row < kRows; ++row) {
    weights.global[static_cast<std::size_t>(row)] = GlobalWeight(row);
    for (int band = 0; band < kLbdBands; ++band) {
      const double center = (band + 0.5) * kLbdBandWidth - 0.5;
      weights.local[static_cast<std::size_t>(band)][static_cast<std::size_t>(row)] =
          LocalWeight(row - center);
    }
  }
  return weights;
}

using RegionSums = std::array<RowSums, kRows>;

RegionSums SumRows(const GradientImage& gradient, const Segment2& segment) {
  RegionSums sums;
  const double length = segment.Length();
  const Eigen::Vector2d direction = segment.Direction();
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  const int columns = std::clamp(static_cast<int>(std::ceil(length)), 1, kMaxColumns);
  const Eigen::Vector2d step = direction * (length / columns);
  const auto dx = static_cast<float>(direction.x());
  const auto dy = static_cast<float>(direction.y());
  // Pixel coordinates step in fixed point: 16 bits below the point.
  constexpr double kOne = 65536;
  const auto step_x = static_cast<std::int64_t>(step.x() * kOne);
  const auto step_y = static_cast<std::int64_t>(step.y() * kOne);
  for (int row = 0; row < kRows; ++row) {
    const Eigen::Vector2d first = segment.start + 0.5 * step + (row - 0.5 * (kRows - 1)) * normal;
    auto fixed_x = static_cast<std::int64_t>((first.x() + 0.5) * kOne);
    auto fixed_y = static_cast<std::int64_t>((first.y() + 0.5) * kOne);
    float across_sum = 0;
    float across_size = 0;
    float along_sum = 0;
    float along_size = 0;
    int count = 0;
    for (int column = 0; column < columns; ++column, fixed_x += step_x, fixed_y += step_y) {
      const std::int64_t x = fixed_x >> 16;
      const std::int64_t y = fixed_y >> 16;
      if (x < 0 || y < 0 || x >= gradient.width() || y >= gradient.height()) continue;
      const auto gx = static_cast<float>(gradient.dx.row(static_cast<int>(y))[x]);
      const auto gy = static_cast<float>(gradient.dy.row(static_cast<int>(y))[x]);
      const float across = gy * dx - gx * dy;
      const float along = gx * dx + gy * dy;
      across_sum += across;
      across_size += std::abs(across);
      along_sum += along;
      along_size += std::abs(along);
      ++count;
    }
    if (count == 0) continue;
    RowSums& out = sums[static_cast<std::size_t>(row)];
    out.valid = true;
    const double scale = 0.5 / count;
    // Sum of the positive and of the negative parts from the sum and the sum of magnitudes.
    out.value = {scale * static_cast<double>(across_size + across_sum),
                 scale * static_cast<double>(across_size - across_sum),
                 scale * static_cast<double>(along_size + along_sum),
                 scale * static_cast<double>(along_size - along_sum)};
  }
  return sums;
}

// Scales the entries first, first + 8 * i + k (k < 4) of all bands to unit norm, large ones
// limited.
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
  static const Weights kWeights = MakeWeights();
  LbdVector result{};
  const double length = segment.Length();
  // A line that long has left every image; this also keeps the pixel coordinates inside int.
  if (!(length > 0) || !(length < 1e6) || !(segment.start.norm() < 1e6)) return result;
  const RegionSums sums = SumRows(gradient, segment);
  for (int band = 0; band < kLbdBands; ++band) {
    const int begin = std::max(0, (band - 1) * kLbdBandWidth);
    const int end = std::min(kRows, (band + 2) * kLbdBandWidth);
    std::array<double, 4> sum{};
    std::array<double, 4> squares{};
    int count = 0;
    for (int row = begin; row < end; ++row) {
      const auto r = static_cast<std::size_t>(row);
      if (!sums[r].valid) continue;
      const double weight = kWeights.global[r] * kWeights.local[static_cast<std::size_t>(band)][r];
      for (std::size_t k = 0; k < 4; ++k) {
        const double v = weight * sums[r].value[k];
        sum[k] += v;
        squares[k] += v * v;
      }
      ++count;
    }
    if (count == 0) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const double mean = sum[k] / count;
      const double variance = std::max(0.0, squares[k] / count - mean * mean);
      const auto base = static_cast<std::size_t>(8 * band);
      result[base + k] = static_cast<float>(mean);
      result[base + 4 + k] = static_cast<float>(std::sqrt(variance));
    }
  }
  Normalize(&result, 0);
  Normalize(&result, 4);
  return result;
}

Descriptor BinarizeLbd(const LbdVector& vector) {
  // All pairs of the 9 bands in order, without 4 pairs of far bands: those see the least of the
  // line.
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
