// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/filters.h"

#include "plumbline/base/processor.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace plumbline {

namespace {

constexpr int kReach = 3;
constexpr int kTaps = 2 * kReach + 1;
constexpr int kBlock = 32;

// Blurs a row of pixels, in 256ths. `padded` begins kReach before its first pixel.
struct BlurAlong {
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* padded,
                                                const BlurWeights& weights,
                                                int width,
                                                std::uint16_t* blurred) {
    // Clang 14 does not let a lambda capture the names of a structured binding.
    const auto w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3];
    ForBlocks<kBlock>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::uint16_t block[size];
          const std::uint8_t* p = padded + first;
          for (int i = 0; i < size; ++i) {
            const auto far = static_cast<std::uint16_t>(p[i] + p[i + 6]);
            const auto middle = static_cast<std::uint16_t>(p[i + 1] + p[i + 5]);
            const auto near = static_cast<std::uint16_t>(p[i + 2] + p[i + 4]);
            block[i] =
                static_cast<std::uint16_t>(w0 * far + w1 * middle + w2 * near + w3 * p[i + 3]);
          }
          std::memcpy(blurred + first, block, sizeof block);
        });
  }
};

using Rows = std::array<const std::uint16_t*, kTaps>;

struct BlurAcross {
  [[gnu::always_inline]] static inline void Run(const Rows& rows,
                                                const BlurWeights& weights,
                                                int width,
                                                std::uint8_t* blurred) {
    const auto r0 = rows[0], r1 = rows[1], r2 = rows[2], r3 = rows[3], r4 = rows[4], r5 = rows[5],
               r6 = rows[6];
    const std::uint32_t w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3];
    constexpr std::uint32_t kHalf = 1U << 15;
    ForBlocks<kBlock>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::uint8_t block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i;
            const std::uint32_t far = std::uint32_t{r0[x]} + r6[x];
            const std::uint32_t middle = std::uint32_t{r1[x]} + r5[x];
            const std::uint32_t near = std::uint32_t{r2[x]} + r4[x];
            const std::uint32_t sum = w0 * far + w1 * middle + w2 * near + w3 * r3[x];
            block[i] = static_cast<std::uint8_t>((sum + kHalf) >> 16);
          }
          std::memcpy(blurred + first, block, size);
        });
  }
};

// Returns the pixel that stands for one beyond the border of a row or column of this size.
int Inside(int place, int size, ImageBorder border) {
  if (border == ImageBorder::kRepeated || size == 1) return std::clamp(place, 0, size - 1);
  while (place < 0 || place >= size) place = place < 0 ? -place : 2 * (size - 1) - place;
  return place;
}

}  // namespace

GrayImage Blurred(const GrayImage& image, const BlurWeights& weights, ImageBorder border) {
  const int width = image.width();
  const int height = image.height();
  GrayImage result(width, height);
  if (image.empty()) return result;
  const auto columns = static_cast<std::size_t>(width);
  std::vector<std::uint8_t> padded(columns + 2 * kReach);
  // The last rows that were blurred along the row, with row y at y modulo kKept.
  constexpr int kKept = kTaps + 1;
  std::array<std::vector<std::uint16_t>, kKept> kept;
  for (auto& row : kept) row.resize(columns);
  const auto kept_row = [&](int y) -> std::vector<std::uint16_t>& {
    return kept[static_cast<std::size_t>(y % kKept)];
  };
  int next = 0;
  for (int y = 0; y < height; ++y) {
    for (; next <= std::min(y + kReach, height - 1); ++next) {
      const std::uint8_t* row = image.row(next);
      std::copy_n(row, columns, padded.data() + kReach);
      for (int i = 1; i <= kReach; ++i) {
        padded[static_cast<std::size_t>(kReach - i)] = row[Inside(-i, width, border)];
        padded[columns + static_cast<std::size_t>(kReach + i - 1)] =
            row[Inside(width - 1 + i, width, border)];
      }
      RunBest<BlurAlong>(padded.data(), weights, width, kept_row(next).data());
    }
    Rows rows;
    for (int k = 0; k < kTaps; ++k) {
      rows[static_cast<std::size_t>(k)] = kept_row(Inside(y + k - kReach, height, border)).data();
    }
    RunBest<BlurAcross>(rows, weights, width, result.row(y));
  }
  return result;
}

namespace {

// Three rows of pixels, weighted by 1, 2, 1 and by -1, 0, 1, with one more column at either end.
struct RowPair {
  std::vector<std::int16_t> smooth;
  std::vector<std::int16_t> change;
};

// Applies the Sobel operator to one row, whose border is repeated.
struct SobelOfRow {
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* above,
                                                const std::uint8_t* row,
                                                const std::uint8_t* below,
                                                int width,
                                                RowPair* rows,
                                                std::int16_t* dx,
                                                std::int16_t* dy) {
    std::int16_t* smooth = rows->smooth.data() + 1;
    std::int16_t* change = rows->change.data() + 1;
    ForBlocks<32>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::int16_t smooth_block[size], change_block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i;
            smooth_block[i] = static_cast<std::int16_t>(above[x] + 2 * row[x] + below[x]);
            change_block[i] = static_cast<std::int16_t>(below[x] - above[x]);
          }
          std::memcpy(smooth + first, smooth_block, sizeof smooth_block);
          std::memcpy(change + first, change_block, sizeof change_block);
        });
    for (std::int16_t* r : {smooth, change}) {
      r[-1] = r[0];
      r[width] = r[width - 1];
    }
    ForBlocks<32>(
        width, [&](int first, auto size) __attribute__((always_inline)) {
          std::int16_t dx_block[size], dy_block[size];
          for (int i = 0; i < size; ++i) {
            const int x = first + i;
            dx_block[i] = static_cast<std::int16_t>(smooth[x + 1] - smooth[x - 1]);
            dy_block[i] = static_cast<std::int16_t>(change[x - 1] + 2 * change[x] + change[x + 1]);
          }
          std::memcpy(dx + first, dx_block, sizeof dx_block);
          std::memcpy(dy + first, dy_block, sizeof dy_block);
        });
  }
};

GrayImage Smoothed(const GrayImage& image, double sigma) {
  if (sigma == 1) return Blurred(image, kBlurSigma1, ImageBorder::kRepeated);
  GrayImage blurred(image.width(), image.height());
  cv::Mat target = AsMat(blurred);
  const int size = 2 * static_cast<int>(std::ceil(2.5 * sigma)) + 1;
  cv::GaussianBlur(AsMat(image), target, {size, size}, sigma, sigma, cv::BORDER_REPLICATE);
  return blurred;
}

}  // namespace

GradientImage ComputeGradient(const GrayImage& image, double sigma) {
  PLUMBLINE_CHECK(!image.empty(), "gradient of an empty image");
  GradientImage gradient{Image<std::int16_t>(image.width(), image.height()),
                         Image<std::int16_t>(image.width(), image.height())};
  const GrayImage blurred = sigma > 0 ? Smoothed(image, sigma) : GrayImage();
  const GrayImage& smooth = sigma > 0 ? blurred : image;
  const auto with_ends = static_cast<std::size_t>(image.width() + 2);
  RowPair rows{std::vector<std::int16_t>(with_ends), std::vector<std::int16_t>(with_ends)};
  for (int y = 0; y < image.height(); ++y) {
    RunBest<SobelOfRow>(smooth.row(std::max(y - 1, 0)),
                        smooth.row(y),
                        smooth.row(std::min(y + 1, image.height() - 1)),
                        image.width(),
                        &rows,
                        gradient.dx.row(y),
                        gradient.dy.row(y));
  }
  return gradient;
}

GrayImage BoxFiltered(const GrayImage& image, int size) {
  PLUMBLINE_CHECK(size >= 1, "size of a box filter");
  GrayImage result(image.width(), image.height());
  cv::Mat out = AsMat(result);
  cv::blur(AsMat(image), out, {size, size}, {-1, -1}, cv::BORDER_REPLICATE);
  return result;
}

}  // namespace plumbline
